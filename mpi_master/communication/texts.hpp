#pragma once

#include <string>
#include <vector>

#include "mpi_master/communication/communicator.hpp"

namespace fluxel {

/// Collective: everybody's texts, none of which holds a 0, one rank's after another's.
[[nodiscard]] std::vector<std::string> texts_of_all(const Communicator& communicator,
                                                    const std::vector<std::string>& mine);

}  // namespace fluxel
