#pragma once

#include "method/problem.hpp"
#include "method/solution.hpp"

namespace fluxel {

/// Collective: the elements, each rank splitting its sub-scene, and which of them the pixels see.
/// `bytes_to_follow`: what is to be made of so many elements, which memory must have room for too; empty:
/// they alone.
void subdivide(const Problem& problem, const BytesOfElements& bytes_to_follow, Solution& solution);

}  // namespace fluxel
