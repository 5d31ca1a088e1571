#pragma once

#include <span>

#include "core/element.hpp"
#include "method/problem.hpp"
#include "method/solution.hpp"

namespace fluxel {

/// Collective: measures what each group's sides of given temperatures absorb, by paths that are right on
/// average whatever the solution is, and makes the errors of the rows of solution.thermal (on the root) those
/// of their net heat. `H` [W/m2]: an entry an unknown of the mesh, on all ranks. Nothing where faces have
/// convection, whose E and rho the paths do not know.
void measure_heat(const Problem& problem, const ElementView& mesh, std::span<const Rgb> H,
                  Solution& solution);

}  // namespace fluxel
