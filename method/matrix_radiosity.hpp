#pragma once

#include <span>

#include "method/problem.hpp"
#include "method/solution.hpp"
#include "mpi_master/communication/shared_memory.hpp"
#include "mpi_master/steps/form_factor_matrix.hpp"
#include "mpi_master/steps/visibility_job.hpp"

namespace fluxel {

/// What the steps before have made.
struct MatrixParts {
  const SubdividedScene& subdivided;
  Visibility& visibility;      ///< whose rows may be dealt anew
  std::span<const Rgb> start;  ///< radiosity to start from, of all unknowns, or none
  AboutLight light = {};       ///< by coarser meshes
};

/// Collective: the radiosity of an earlier run, held once a host; none where the problem has none.
[[nodiscard]] SharedArray<Rgb> first_radiosity(const Problem& problem, const ElementView& mesh);

/// Collective: form factors, radiosity, and where the power goes; into the leaders' solutions, and said.
void matrix_radiosity(const Problem& problem, const MatrixParts& parts, Solution& solution);

}  // namespace fluxel
