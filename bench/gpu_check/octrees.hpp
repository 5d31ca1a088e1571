#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fluxel::cuda::checks {

/// An octree of references to spheres, built and looked up by the passes that a device runs.
struct OctreeFigures {
  std::string spheres_are;
  std::uint64_t spheres = 0, nodes = 0, references = 0;
  std::uint64_t compared = 0, found = 0, differing = 0;  ///< points of the host, against every sphere
  std::uint64_t points = 0;                              ///< looked up to time it
  bool on_device = false;
  std::uint64_t device_differing = 0;       ///< bytes of the tree and numbers found, against the host's
  double host_build = 0, device_build = 0;  ///< [s], on one core; without copies
  double host_points = 0, device_points = 0, kernel_points = 0;  ///< a second; copies included or not

  [[nodiscard]] bool right() const { return differing == 0 && device_differing == 0; }
};

/// Of so many spheres of each kind and points, on the host, and on device number `device` where that is not
/// negative. Throws DeviceError.
[[nodiscard]] std::vector<OctreeFigures> check_octrees(std::size_t spheres, std::size_t points, int device);

void print_octrees(const std::vector<OctreeFigures>& figures);

[[nodiscard]] std::string to_json(const std::vector<OctreeFigures>& figures);

}  // namespace fluxel::cuda::checks
