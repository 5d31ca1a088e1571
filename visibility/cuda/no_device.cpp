// In place of device_tracer.cu where there is no CUDA compiler.
#include "visibility/cuda/device_tracer.hpp"

namespace fluxel::cuda {

namespace {

constexpr auto kWhy =
    "this program was built without CUDA (install nvcc and configure with -DFLUXEL_CUDA=ON)";

}  // namespace

std::vector<DeviceProperties> find_devices(std::string& why_none) {
  why_none = kWhy;
  return {};
}

std::size_t free_memory_of(int /*device*/) { throw DeviceError(kWhy); }

struct DeviceTracer::State {
  DeviceSeconds seconds;
};

DeviceTracer::DeviceTracer(const SceneArrays& /*scene*/, int /*device*/, std::size_t /*memory*/) {
  throw DeviceError(kWhy);
}
DeviceTracer::~DeviceTracer() = default;

void DeviceTracer::trace(const std::vector<TilePlace>& /*places*/, const Take& /*take*/) {
  throw DeviceError(kWhy);
}

const DeviceSeconds& DeviceTracer::seconds() const { return state_->seconds; }

}  // namespace fluxel::cuda
