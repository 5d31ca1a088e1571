#pragma once

#include "formfactor/escape_fraction.hpp"
#include "mpi_master/communication/shared_memory.hpp"

namespace fluxel {

/// Views of all unknown sides: fronts of all elements, then, with `two_sided`, all backs.
/// Collective: elements are split evenly, each host gets all views.
[[nodiscard]] SharedArray<SideView> gather_side_views(const Communicator& communicator,
                                                      const RayScene& ray_scene, const Scene& scene,
                                                      const ElementView& mesh, bool two_sided, int threads);

}  // namespace fluxel
