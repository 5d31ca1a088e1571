#pragma once

#include "method/problem.hpp"
#include "method/solution.hpp"

namespace fluxel {

/// Collective: the elements, each rank splitting its sub-scene, and which of them the pixels see.
void subdivide(const Problem& problem, Solution& solution);

}  // namespace fluxel
