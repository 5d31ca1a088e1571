#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/gpu_check/scenes.hpp"

namespace fluxel::cuda::checks {

/// Paths of light in a closed room whose surfaces all emit and reflect the same, so that the irradiance is
/// known everywhere: E / (1 - rho).
struct PathFigures {
  std::string scene;
  std::size_t patches = 0;
  std::uint64_t paths = 0;            ///< followed on the host
  double mean = 0, error = 0;         ///< of the irradiance, and its standard error, over the known one
  std::uint64_t device_paths = 0;     ///< compared with the host's
  std::uint64_t differing = 0;        ///< by more than sines and cosines of devices may differ
  double change_of_mean = 0;          ///< of the device's from the host's, over the host's
  double host_rays_per_second = 0;    ///< on one core
  double device_rays_per_second = 0;  ///< copies of paths and what they found included
  double kernel_rays_per_second = 0;

  [[nodiscard]] bool right() const;
};

/// Of so many paths, on the host, and on device number `device` where that is not negative. Throws
/// DeviceError.
[[nodiscard]] PathFigures check_paths(const CheckScene& scene, std::size_t paths, int device,
                                      unsigned threads);

void print_paths(const std::vector<PathFigures>& figures);

[[nodiscard]] std::string to_json(const std::vector<PathFigures>& figures);

}  // namespace fluxel::cuda::checks
