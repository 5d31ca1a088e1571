#pragma once

#include "app/describe.hpp"
#include "app/report.hpp"
#include "core/progress.hpp"
#include "mpi_master/communicator.hpp"
#include "mpi_master/subdivision_job.hpp"
#include "scene/scene.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// What the steps before have made.
struct EstimateParts {
  const Scene& scene;
  const SubdividedScene& subdivided;
  const RayScene& ray_scene;
  bool converged;   ///< the solution in the root's report
  int threads = 1;  ///< of this rank
};

/// Estimates the error of the finished solution without a reference: solves the scene again on the meshes of
/// half and of a quarter of the resolution, and sees how the radiosity changes; into the root's report, and
/// told. Collective. A signal ends it alone: the run goes on without an estimate.
void estimate_step(const Communicator& world, const EstimateParts& parts, const Teller& teller,
                   Progress& progress, RunReport& report);

}  // namespace fluxel
