#pragma once

#include <span>

#include "core/log.hpp"
#include "mpi_master/steps/rank_device.hpp"

namespace fluxel {

/// Warns of the GPUs that have failed in a phase, in one sentence, if there are any.
void warn_of_device_failures(const char* phase, std::span<const DeviceFailure> failures, Log& log);

}  // namespace fluxel
