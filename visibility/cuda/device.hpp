#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace fluxel::cuda {

/// What a device or its driver could not do, as a sentence.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct DeviceFacts {
  std::string name;
  std::size_t memory = 0, free_memory = 0;  ///< [bytes]
  int multiprocessors = 0;
  int major = 0, minor = 0;  ///< compute capability
};

/// The devices that this process can use, by number; where there are none, `why_none` is a sentence.
[[nodiscard]] std::vector<DeviceFacts> find_devices(std::string& why_none);

/// What the parts of the work took on the device [s].
struct DeviceSeconds {
  double kernel = 0, transfer = 0;
};

}  // namespace fluxel::cuda
