#pragma once

#include <string>
#include <vector>

#include "mpi_master/communication/machine.hpp"

namespace fluxel {

/// Sentences on launches that waste the machine: ranks bound to one core while others idle, on whichever
/// hosts; threads that share the CPUs of a rank that is bound too narrowly; N copies of rank 0, as the
/// launcher's environment tells. `threads_asked` is 0 where a rank takes what its CPU set has.
[[nodiscard]] std::vector<std::string> launch_warnings(const std::vector<RankPlace>& places,
                                                       int threads_asked);

}  // namespace fluxel
