// In place of device_limits.cu where there is no CUDA compiler.
#include "bench/gpu_check/device_limits.hpp"
#include "visibility/cuda/device_tracer.hpp"

namespace fluxel::cuda::checks {

DeviceLimits limits_of(int /*device*/) { throw DeviceError("this program was built without CUDA"); }

}  // namespace fluxel::cuda::checks
