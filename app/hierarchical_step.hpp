#pragma once

#include <vector>

#include "app/describe.hpp"
#include "app/report.hpp"
#include "core/progress.hpp"
#include "mpi_master/subdivision_job.hpp"

namespace fluxel {

/// Collective: radiosity by blocks, in place of the visibility and the solve of all pairs; into the reports
/// of all ranks. With Subdivision::transport `subdivided` gets the leaves as elements, with others each
/// element gathers its light. `picture_irradiance` becomes that of each of the raster's pixels on its own.
/// Whether all has converged.
[[nodiscard]] bool hierarchical_step(const Communicator& world, const Scene& scene, int threads,
                                     SubdividedScene& subdivided, std::vector<Rgb>& picture_irradiance,
                                     const Teller& teller, Progress& progress, RunReport& report);

}  // namespace fluxel
