#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "reference/cuda/path_follower.hpp"
#include "reference/light_paths.hpp"
#include "visibility/cuda/verified_counts.hpp"

namespace fluxel {

/// A rank's GPU, which follows paths in place of a LightPaths without a finished solution; some of them the
/// LightPaths follows again. For one thread at a time, whose task arena works on what the processor does.
class VerifiedPaths {
 public:
  /// `paths` must outlive this. `verified`: the share of the paths that it follows again; `required`: the
  /// rank may not go on without the device.
  VerifiedPaths(std::unique_ptr<cuda::PathFollower> follower, const LightPaths& paths, double verified,
                bool required);

  /// How many paths should be given at a time.
  [[nodiscard]] std::size_t paths_at_once() const { return follower_->paths_at_once(); }

  /// As LightPaths::irradiance. Where the device fails the processor follows these paths, and all others
  /// from then on; throws InputError where the device is required.
  void irradiance(std::span<const PathStart> starts, std::span<Rgb> found, std::uint64_t& rays);

  [[nodiscard]] const VerifiedCounts& counts() const { return counts_; }
  /// A sentence; empty: the device has not failed.
  [[nodiscard]] const std::string& failure() const { return failure_; }

 private:
  void by_device(std::span<const PathStart> starts, std::span<Rgb> found, std::uint64_t& rays);
  void by_processor(std::span<const PathStart> starts, std::span<Rgb> found, std::uint64_t& rays) const;
  void verify(std::span<const PathStart> starts, std::span<const Rgb> found);

  std::unique_ptr<cuda::PathFollower> follower_;
  const LightPaths& paths_;
  double verified_;
  bool required_;
  VerifiedCounts counts_;
  std::string failure_;
};

}  // namespace fluxel
