// In place of device_rows.cu where there is no CUDA compiler.
#include "solver/cuda/device_rows.hpp"

#include <string>

namespace fluxel::cuda {

struct DeviceRows::State {};

DeviceRows::DeviceRows(const RowMatrix& /*matrix*/, int /*device*/, std::size_t /*memory*/) {
  std::string why;
  static_cast<void>(find_devices(why));
  throw DeviceError(why);
}
DeviceRows::~DeviceRows() = default;

// There is none to call these on.
void DeviceRows::start(const float* /*power*/, const std::uint8_t* /*sends*/, std::uint32_t /*channels*/) {}
const double* DeviceRows::gather(std::uint32_t /*first*/, std::uint32_t /*last*/) { return nullptr; }
DeviceSeconds DeviceRows::seconds() const { return {}; }

}  // namespace fluxel::cuda
