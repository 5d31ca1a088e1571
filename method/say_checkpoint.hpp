#pragma once

#include "method/problem.hpp"
#include "method/solution.hpp"

namespace fluxel {

/// Says what has been kept on disk, if anything was to be.
void say_checkpoint(const Problem& problem, const Solution& solution);

}  // namespace fluxel
