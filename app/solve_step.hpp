#pragma once

#include <span>

#include "app/describe.hpp"
#include "app/report.hpp"
#include "core/progress.hpp"
#include "mpi_master/communicator.hpp"
#include "mpi_master/subdivision_job.hpp"
#include "scene/scene.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// What the steps before have made.
struct SolveParts {
  const Scene& scene;
  const SubdividedScene& subdivided;
  const RayScene& ray_scene;
  const Visibility& visibility;
  std::span<const Rgb> start;  ///< radiosity of an earlier run, or none
  int threads = 1;             ///< of this rank
};

/// Form factors, radiosity, and where the power goes; into the report, and told. Collective.
void solve_step(const Communicator& world, const SolveParts& parts, const Teller& teller, Progress& progress,
                RunReport& report);

}  // namespace fluxel
