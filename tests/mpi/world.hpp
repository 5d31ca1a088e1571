#pragma once

#include "mpi_master/communication/communicator.hpp"

namespace fluxel::test {

/// All ranks of the test program; every test runs on all of them at once.
[[nodiscard]] const Communicator& world();

/// This rank and the number of ranks, as sizes for loops and indices.
[[nodiscard]] inline std::size_t own_rank() { return static_cast<std::size_t>(world().rank()); }
[[nodiscard]] inline std::size_t ranks() { return static_cast<std::size_t>(world().size()); }

}  // namespace fluxel::test
