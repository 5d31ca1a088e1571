#pragma once

#include "method/problem.hpp"
#include "method/solution.hpp"

namespace fluxel {

/// Collective: measures how far the elements' radiosity is off at places of the picture, or without a camera
/// of the surfaces, an element shown as one shade included; said, and into the solution. A signal ends the
/// audit alone.
void audit_matrix(const Problem& problem, Solution& solution);

}  // namespace fluxel
