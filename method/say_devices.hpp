#pragma once

#include <span>

#include "core/log.hpp"
#include "mpi_master/steps/rank_device.hpp"

namespace fluxel {

/// Says which GPUs are used, and in how many ranks; why not where a user may have expected one.
void say_devices(const JobDevices& devices, int ranks, Log& log);

/// Warns of the GPUs that have failed in a phase, in one sentence, if there are any.
void warn_of_device_failures(const char* phase, std::span<const DeviceFailure> failures, Log& log);

}  // namespace fluxel
