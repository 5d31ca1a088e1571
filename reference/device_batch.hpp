#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "reference/path_sum.hpp"
#include "reference/sensors.hpp"
#include "reference/verified_paths.hpp"

namespace fluxel {

/// As PathBatch, of as many paths as a GPU should be given at a time. For one thread at a time.
class DeviceBatch {
 public:
  /// Of the host's memory, for a path that waits [bytes]: its sensor, its start twice, what it has found.
  static constexpr std::size_t kBytesOfPath = 512;

  /// Both must outlive this.
  DeviceBatch(const PathSensors& sensors, VerifiedPaths& device) : sensors_(sensors), device_(device) {}

  /// What the path finds is added to `sum`, which must not move, when the batch is full or traced; sums of
  /// several paths are formed in the order of the calls.
  void add(const SensorPath& path, PathSum& sum);

  /// Traces what has been collected. Throws InputError: see VerifiedPaths::irradiance.
  void trace();

  [[nodiscard]] std::uint64_t rays() const { return rays_; }
  [[nodiscard]] const VerifiedPaths& device() const { return device_; }

 private:
  [[nodiscard]] std::vector<SensorStart> started();

  const PathSensors& sensors_;
  VerifiedPaths& device_;
  std::vector<SensorPath> paths_;
  std::vector<PathSum*> sums_;
  std::uint64_t rays_ = 0;
};

}  // namespace fluxel
