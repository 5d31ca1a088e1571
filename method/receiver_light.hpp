#pragma once

#include "method/problem.hpp"
#include "method/solution.hpp"

namespace fluxel {

/// Collective, when the radiosity of the unknowns is known: the irradiance of every receiver's cells by a
/// final gather, light from emitters by paths and light from other surfaces as the solution has it.
void gather_receivers(const Problem& problem, Solution& solution);

/// Relative error that the solution is expected to have, root mean square over the mean, beside that of a
/// gather's own rays; 0 where nothing is known of it. On the root.
[[nodiscard]] double expected_error(const Solution& solution);

}  // namespace fluxel
