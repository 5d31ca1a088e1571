// In place of device_paths.cu where there is no CUDA compiler.
#include <string>

#include "reference/cuda/device_paths.hpp"

namespace fluxel::cuda {

struct DevicePaths::State {};

DevicePaths::DevicePaths(const PathArrays& /*arrays*/, int /*device*/, std::size_t /*memory*/) {
  std::string why;
  static_cast<void>(find_devices(why));
  throw DeviceError(why);
}
DevicePaths::~DevicePaths() = default;

// There is none to call these on.
std::size_t DevicePaths::paths_at_once() const { return 0; }
std::vector<PathEstimate> DevicePaths::follow(const std::vector<PathBegin>& /*paths*/) { return {}; }
DeviceSeconds DevicePaths::seconds() const { return {}; }

}  // namespace fluxel::cuda
