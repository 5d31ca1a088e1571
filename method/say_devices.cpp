#include "method/say_devices.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fluxel {

void say_devices(const JobDevices& devices, int ranks, Log& log) {
  if (devices.ranks > 0)
    log.say(fmt::format("GPUs: {}, in {} of {} ranks", fmt::join(devices.names, ", "), devices.ranks, ranks));
  if (!devices.without.empty())
    log.say(fmt::format("note: {} of {} ranks work without a GPU: {}", devices.without.size(), ranks,
                        devices.without.front().reason));
}

void warn_of_device_failures(const char* phase, std::span<const DeviceFailure> failures, Log& log) {
  if (failures.empty()) return;
  log.warn(fmt::format("GPUs of {} ranks have failed in the {}, and processors went on: {} (rank {})",
                       failures.size(), phase, failures.front().reason, failures.front().rank));
}

}  // namespace fluxel
