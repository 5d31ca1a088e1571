#pragma once

#include <span>

#include "core/element.hpp"
#include "core/progress.hpp"
#include "hierarchy/gather.hpp"
#include "hierarchy/hierarchy.hpp"
#include "mpi_master/steps/subdivision_job.hpp"
#include "solver/iterate.hpp"

namespace fluxel {

/// Collective: the tree's leaves as the elements of the run, and each pixel's; `points` are those of the
/// raster's pixels.
void take_leaves(const Communicator& world, const NodeTree& tree, std::span<const GatherPoint> points,
                 SubdividedScene& subdivided);

/// Collective: light of elements that were made otherwise: means of what the tree has below them, or gathered
/// at four points of each where the tree is coarser or cut otherwise.
[[nodiscard]] Radiosity light_of_elements(Hierarchy& hierarchy, const ElementView& mesh,
                                          const GatherGoal& goal, Progress& progress);

}  // namespace fluxel
