#include "method/device_warning.hpp"

#include <fmt/format.h>

namespace fluxel {

void warn_of_device_failures(const char* phase, std::span<const DeviceFailure> failures, Log& log) {
  if (failures.empty()) return;
  log.warn(fmt::format("GPUs of {} ranks have failed in the {}, and processors went on: {} (rank {})",
                       failures.size(), phase, failures.front().reason, failures.front().rank));
}

}  // namespace fluxel
