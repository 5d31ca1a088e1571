#include "reference/verified_paths.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/sampling.hpp"
#include "reference/cuda/same_path.hpp"
#include "reference/path_batch.hpp"
#include "reference/path_device.hpp"
#include "visibility/cuda/device.hpp"

namespace fluxel {

namespace {

/// Evenly spread in [0, 1), by the path's numbers alone.
double spread(const PathStart& start) {
  const cuda::PathNumbers& numbers = start.numbers.state();
  return 0x1p-64 * static_cast<double>(random_bits(random_bits(numbers.seed) ^ numbers.index));
}

cuda::Double3 channels(const Rgb& colour) { return {colour.r, colour.g, colour.b}; }

}  // namespace

VerifiedPaths::VerifiedPaths(std::unique_ptr<cuda::PathFollower> follower, const LightPaths& paths,
                             double verified, bool required)
    : follower_(std::move(follower)), paths_(paths), verified_(verified), required_(required) {}

void VerifiedPaths::irradiance(std::span<const PathStart> starts, std::span<Rgb> found, std::uint64_t& rays) {
  if (failure_.empty()) {
    try {
      by_device(starts, found, rays);
      return;
    } catch (const cuda::DeviceError& error) {
      if (required_) throw InputError(std::string(error.what()) + " (--device auto goes on without)");
      failure_ = error.what();
    }
  }
  by_processor(starts, found, rays);
}

void VerifiedPaths::by_device(std::span<const PathStart> starts, std::span<Rgb> found, std::uint64_t& rays) {
  std::vector<cuda::PathBegin> begins;
  begins.reserve(starts.size());
  for (const PathStart& start : starts) begins.push_back(path_begin(start));
  const std::vector<cuda::PathEstimate> estimates = follower_->follow(begins);
  for (std::size_t k = 0; k < starts.size(); ++k) {
    const cuda::Double3& irradiance = estimates[k].irradiance;
    found[k] = {irradiance.x, irradiance.y, irradiance.z};
    rays += estimates[k].rays;
  }
  counts_.made += starts.size();
  verify(starts, found);
}

void VerifiedPaths::by_processor(std::span<const PathStart> starts, std::span<Rgb> found,
                                 std::uint64_t& rays) const {
  std::atomic<std::uint64_t> traced = 0;
  const tbb::blocked_range<std::size_t> all(0, starts.size(), PathBatch::kMostPaths);
  tbb::parallel_for(all, [&](const auto& range) {
    std::uint64_t of_range = 0;
    paths_.irradiance(starts.subspan(range.begin(), range.size()), found.subspan(range.begin(), range.size()),
                      of_range);
    traced += of_range;
  });
  rays += traced;
}

void VerifiedPaths::verify(std::span<const PathStart> starts, std::span<const Rgb> found) {
  std::vector<PathStart> again;
  std::vector<Rgb> by_device;
  for (std::size_t k = 0; k < starts.size(); ++k) {
    if (!(verified_ > 0 && spread(starts[k]) <= verified_)) continue;
    again.push_back(starts[k]);
    by_device.push_back(found[k]);
  }
  std::vector<Rgb> expected(again.size());
  std::uint64_t rays = 0;  // not of the measurement
  by_processor(again, expected, rays);
  counts_.verified += again.size();
  for (std::size_t k = 0; k < again.size(); ++k)
    if (!cuda::is_same_path(channels(by_device[k]), channels(expected[k]))) ++counts_.differing;
}

}  // namespace fluxel
