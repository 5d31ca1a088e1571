#pragma once

#include "mpi_master/communication/communicator.hpp"

namespace fluxel::test {

/// This process alone.
[[nodiscard]] const Communicator& world();

}  // namespace fluxel::test
