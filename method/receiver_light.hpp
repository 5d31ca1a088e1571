#pragma once

#include <span>

#include "core/element.hpp"
#include "method/problem.hpp"
#include "method/solution.hpp"

namespace fluxel {

/// Collective, when light is known: what every receiver measures, and observers' glare, by a final gather,
/// two surfaces deep, light from emitters by paths and light from the second surface as the solution has it:
/// `H` [W/m2], an entry an unknown of the mesh, on all ranks. A signal ends the gather alone.
void gather_receivers(const Problem& problem, const ElementView& mesh, std::span<const Rgb> H,
                      Solution& solution);

}  // namespace fluxel
