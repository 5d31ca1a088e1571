#pragma once

#include <optional>

#include "method/problem.hpp"
#include "method/solution.hpp"
#include "metrics/glare_rating.hpp"
#include "reference/light_paths.hpp"

namespace fluxel {

/// Collective: how much each observer is dazzled (Solution::glare), by paths that have the light of the
/// solution or of none. Sources are what emits and is seen above the line of sight: luminaires' openings,
/// of which one of less than 0.005 m2 counts as that large (CIE 147:2002), and emitting surfaces. The
/// background is what else lights the eye: E_i / pi.
void rate_glare(const Problem& problem, const LightPaths& paths, const PathGoal& goal, Solution& solution);

}  // namespace fluxel
