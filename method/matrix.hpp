#pragma once

#include "method/problem.hpp"
#include "method/solution.hpp"
#include "mpi_master/steps/subdivision_job.hpp"

namespace fluxel {

/// Collective: visibility, form factors and radiosity of all pairs of a mesh's elements.
void solve_mesh(const Problem& problem, const SubdividedScene& subdivided, Solution& solution);

}  // namespace fluxel
