#pragma once

namespace fluxel::cuda::checks {

/// What a device can do at most.
struct DeviceLimits {
  // Measured [bytes/s]. A copy within the device counts twice, as it reads and writes.
  double copy_on_device = 0, copy_to_device = 0, copy_to_host = 0;
  // Of the properties of the card, estimated [1/s]: products or sums, each rounded for itself.
  double single_operations = 0, double_operations = 0;
};

/// Throws DeviceError.
[[nodiscard]] DeviceLimits limits_of(int device);

}  // namespace fluxel::cuda::checks
