// In place of device_octree.cu where there is no CUDA compiler.
#include <string>

#include "octree/cuda/device_octree.hpp"

namespace fluxel::cuda {

struct DeviceOctree::State {};

DeviceOctree::DeviceOctree(const std::vector<Sphere>& /*spheres*/, int /*device*/, std::size_t /*memory*/) {
  std::string why;
  static_cast<void>(find_devices(why));
  throw DeviceError(why);
}
DeviceOctree::~DeviceOctree() = default;

// There is none to call these on.
OctreeArrays DeviceOctree::arrays() const { return {}; }
HoldingSpheres DeviceOctree::find(const std::vector<OctreePoint>& /*points*/) { return {}; }
DeviceSeconds DeviceOctree::seconds() const { return {}; }

}  // namespace fluxel::cuda
