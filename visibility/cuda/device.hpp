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

/// For such sentences.
inline std::string megabytes(std::size_t bytes) {
  return std::to_string((bytes + 999'999) / 1'000'000) + " MB";
}

struct DeviceProperties {
  std::string name;
  std::string id;          ///< the same in every process, whatever number the device has there
  std::size_t memory = 0;  ///< [bytes]
  int multiprocessors = 0;
  int major = 0, minor = 0;  ///< compute capability
};

/// The devices that this process is shown, by number; where there are none, `why_none` is a sentence. Takes
/// nothing of them.
[[nodiscard]] std::vector<DeviceProperties> find_devices(std::string& why_none);

/// [bytes]; the driver has taken what it needs of a device for this process. Throws DeviceError where the
/// process may not use it.
[[nodiscard]] std::size_t free_memory_of(int device);

/// What the parts of the work took on the device [s].
struct DeviceSeconds {
  double kernel = 0, transfer = 0;
};

}  // namespace fluxel::cuda
