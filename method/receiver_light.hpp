#pragma once

#include <span>

#include "core/element.hpp"
#include "method/problem.hpp"
#include "method/solution.hpp"

namespace fluxel {

/// Collective, when light is known: what every receiver measures, and observers' glare, by paths that bring
/// the difference from the solution, which takes variance away and no more: `H` [W/m2], an entry an unknown
/// of the mesh, on all ranks. A signal ends the gather alone.
void gather_receivers(const Problem& problem, const ElementView& mesh, std::span<const Rgb> H,
                      Solution& solution);

}  // namespace fluxel
