#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "octree/octree_arrays.hpp"
#include "octree/octree_look_up.hpp"
#include "visibility/cuda/device.hpp"

namespace fluxel::cuda {

/// An octree of references on a GPU: the same byte by byte as SphereOctree's. For one thread at a time.
class DeviceOctree {
 public:
  /// Copies the spheres, which are finite, to a device and builds the tree there. Throws DeviceError where
  /// that takes more than `memory` bytes there, or the device cannot be used.
  DeviceOctree(const std::vector<Sphere>& spheres, int device, std::size_t memory);
  ~DeviceOctree();

  /// A copy. Throws DeviceError.
  [[nodiscard]] OctreeArrays arrays() const;

  /// The spheres that hold each point. Throws DeviceError.
  [[nodiscard]] HoldingSpheres find(const std::vector<OctreePoint>& points);

  /// Of all that was done: kernels with the sums and sorts between them, and copies.
  [[nodiscard]] DeviceSeconds seconds() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fluxel::cuda
