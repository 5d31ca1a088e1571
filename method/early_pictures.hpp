#pragma once

#include "method/problem.hpp"
#include "solver/radiosity_operator.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

/// How many early pictures there are: after 1, 2, 4 and 8 s.
inline constexpr std::size_t kEarlyPictures = 4;

/// Collective: shoots the brightest light first and hands the problem's hook a radiosity after
/// 2^k seconds (a shot under way is finished first); ends after the last one, or earlier when next to nothing
/// is left to shoot. The solver that follows starts afresh, so that its result does not depend on the clock.
/// `unknowns` are this rank's.
void shoot_early_pictures(const Problem& problem, const SubdividedScene& subdivided, RadiosityOperator& F,
                          const Unknowns& unknowns);

}  // namespace fluxel
