#pragma once

#include "method/problem.hpp"
#include "method/solution.hpp"

namespace fluxel {

// A method answers what light there is at the sensors of a problem. All are collective, and throw AgreedError
// where memory does not suffice, StopRequest where a signal has ended them.

/// All pairs of elements: one bit of visibility a pair, form factors on the fly (the source papers' method).
[[nodiscard]] Solution solve_matrix(const Problem& problem);
/// What solve_matrix would take: elements, pairs, memory and time.
[[nodiscard]] Solution forecast_matrix(const Problem& problem);
/// After the picture and the solution are written: solves two coarser meshes and estimates how far the
/// solution is from the true radiosity; into the root's solution, and said. A signal ends the estimate alone.
void estimate_matrix_error(const Problem& problem, Solution& solution);

/// Links between nodes of a hierarchy, refined until the error asked for is expected.
[[nodiscard]] Solution solve_hierarchical(const Problem& problem);

/// Paths of light from the sensors to the emitters: unbiased, with standard errors.
[[nodiscard]] Solution trace_paths(const Problem& problem);

}  // namespace fluxel
