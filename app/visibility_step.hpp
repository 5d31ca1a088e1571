#pragma once

#include <span>

#include "app/describe.hpp"
#include "app/report.hpp"
#include "core/element.hpp"
#include "core/progress.hpp"
#include "mpi_master/communicator.hpp"
#include "mpi_master/visibility_job.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// The visibility matrix, computed or taken from earlier jobs, and kept where the options ask for it; into
/// the report, and told. Collective. Throws AgreedError where folders of strips cannot be used, StopRequest
/// after a signal.
[[nodiscard]] Visibility visibility_step(const Communicator& world, const RayScene& ray_scene,
                                         std::span<const Element> elements, const TileTracer& tracer,
                                         int threads, const Teller& teller, Progress& progress,
                                         RunReport& report);

/// Rays, tiles, what was kept; told when the phase's time is known.
void describe_visibility(const Teller& teller, const RunReport& report);

}  // namespace fluxel
