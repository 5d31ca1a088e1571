// In place of device_hits.cu where there is no CUDA compiler.
#include <string>

#include "visibility/cuda/device_hits.hpp"

namespace fluxel::cuda {

struct DeviceHits::State {};

DeviceHits::DeviceHits(const SceneArrays& /*scene*/, int /*device*/, std::size_t /*memory*/) {
  std::string why;
  static_cast<void>(find_devices(why));
  throw DeviceError(why);
}
DeviceHits::~DeviceHits() = default;

// There is none to call these on.
std::size_t DeviceHits::rays_at_once() const { return 0; }
std::vector<NearestHit> DeviceHits::find(const std::vector<Ray>& /*rays*/) { return {}; }
DeviceSeconds DeviceHits::seconds() const { return {}; }

}  // namespace fluxel::cuda
