#pragma once

#include "app/describe.hpp"
#include "app/report.hpp"
#include "mpi_master/communicator.hpp"
#include "mpi_master/subdivision_job.hpp"
#include "scene/scene.hpp"
#include "solver/radiosity_operator.hpp"

namespace fluxel {

/// Writes preview-1s.png, -2s, -4s and -8s into the run's folder, each when the light has been shot for so
/// long (a shot under way is finished first), and ends then, or earlier when next to nothing is left to
/// shoot. Earlier runs' previews are removed. The solver that follows starts afresh, so that its result does
/// not depend on the clock. Collective on the leaders. Throws InputError where a file cannot be written.
void write_previews(const Communicator& leaders, const Scene& scene, const SubdividedScene& subdivided,
                    RadiosityOperator& F, const Unknowns& unknowns, const Teller& teller, RunReport& report);

}  // namespace fluxel
