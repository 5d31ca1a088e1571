#pragma once

#include <vector>

#include "core/rgb.hpp"
#include "method/problem.hpp"
#include "method/solution.hpp"
#include "mpi_master/steps/subdivision_job.hpp"

namespace fluxel {

/// Collective: the radiosity of two meshes coarser than the run's, the coarsest first, from which the next
/// finer one starts. The run's own iteration starts from them in turn (nested iteration: Hackbusch 1985,
/// Multi-Grid Methods and Applications, chapter 5), and they tell its error. Fewer, or none, where elements
/// cannot be merged. Throws StopRequest after a signal.
[[nodiscard]] CoarserSolutions solve_coarser_meshes(const Problem& problem,
                                                    const SubdividedScene& subdivided);

/// Of elements of the next finer mesh, each that of the coarser one that it is a part of; values are of
/// fronts, then, where elements are two-sided, of backs. Empty where there are no values.
[[nodiscard]] std::vector<Rgb> on_parts(std::span<const Rgb> values, std::span<const std::uint32_t> first);

}  // namespace fluxel
