#pragma once

#include "mpi_master/communication/communicator.hpp"

namespace fluxel {

struct CompareOptions;

/// Collective: `fluxel compare`. The options matter on the root alone, which does all the work. Prints the
/// errors of A against B as a table and, where a folder is given, writes compare.json, histogram.csv and the
/// signed error: error.exr and error.png of pixels, error.ply of elements. Returns the exit code: 3 where the
/// error is above CompareOptions::fail_above.
[[nodiscard]] int run_compare(const Communicator& world, const CompareOptions& options);

}  // namespace fluxel
