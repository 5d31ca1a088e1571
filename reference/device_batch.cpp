#include "reference/device_batch.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <span>

#include "reference/path_batch.hpp"

namespace fluxel {

void DeviceBatch::add(const SensorPath& path, PathSum& sum) {
  paths_.push_back(path);
  sums_.push_back(&sum);
  if (paths_.size() >= device_.paths_at_once()) trace();
}

void DeviceBatch::trace() {
  const std::vector<SensorStart> starts = started();
  std::vector<PathStart> begins;
  begins.reserve(starts.size());
  for (const SensorStart& start : starts) begins.push_back(start.path);
  std::vector<Rgb> irradiance(starts.size());
  device_.irradiance(begins, irradiance, rays_);
  // Paths that start nowhere have found 0.
  for (std::size_t k = 0; k < starts.size(); ++k)
    sums_[starts[k].number]->add(starts[k].value(irradiance[k]));
  paths_.clear();
  sums_.clear();
}

/// Of all paths, in their order.
std::vector<SensorStart> DeviceBatch::started() {
  constexpr std::size_t kPart = PathBatch::kMostPaths;
  std::vector<std::vector<SensorStart>> parts((paths_.size() + kPart - 1) / kPart);
  std::atomic<std::uint64_t> rays = 0;
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
    const std::size_t first = part * kPart;
    const auto some = std::span(paths_).subspan(first, std::min(kPart, paths_.size() - first));
    std::uint64_t of_part = 0;
    sensors_.start(some, parts[part], of_part);
    for (SensorStart& start : parts[part]) start.number += first;
    rays += of_part;
  });
  rays_ += rays;
  std::vector<SensorStart> all;
  for (std::vector<SensorStart>& part : parts) {
    all.insert(all.end(), part.begin(), part.end());
    part = {};
  }
  return all;
}

}  // namespace fluxel
