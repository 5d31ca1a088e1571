#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "reference/path_sum.hpp"
#include "reference/sensors.hpp"

namespace fluxel {

/// Collects paths until there are enough to trace side by side.
class PathBatch {
 public:
  /// Enough for full packets of rays after several bounces, and few enough for the processor's cache.
  static constexpr std::size_t kMostPaths = 256;

  /// The sensors must outlive this.
  explicit PathBatch(const Sensors& sensors) : sensors_(sensors) {}

  /// What the path finds is added to `sum`, which must not move, when the batch is full or traced; sums of
  /// several paths are formed in the order of the calls.
  void add(const SensorPath& path, PathSum& sum) {
    paths_.push_back(path);
    sums_.push_back(&sum);
    if (paths_.size() == kMostPaths) trace();
  }

  /// Traces what has been collected.
  void trace() {
    found_.resize(paths_.size());
    sensors_.measure(paths_, found_, rays_);
    for (std::size_t k = 0; k < paths_.size(); ++k) sums_[k]->add(found_[k]);
    paths_.clear();
    sums_.clear();
  }

  [[nodiscard]] std::uint64_t rays() const { return rays_; }

 private:
  const Sensors& sensors_;
  std::vector<SensorPath> paths_;
  std::vector<PathSum*> sums_;
  std::vector<Rgb> found_;
  std::uint64_t rays_ = 0;
};

}  // namespace fluxel
