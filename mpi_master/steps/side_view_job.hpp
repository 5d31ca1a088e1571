#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formfactor/escape_fraction.hpp"
#include "mpi_master/communication/shared_memory.hpp"

namespace fluxel {

/// Views of all unknown sides: fronts of all elements, then, with `two_sided`, all backs.
/// Collective: elements are split evenly, each host gets all views.
[[nodiscard]] SharedArray<SideView> gather_side_views(const Communicator& communicator,
                                                      const RayScene& ray_scene, const Scene& scene,
                                                      const ElementView& mesh, bool two_sided, int threads);

/// Views of these sides, by the numbers of their unknowns as above. Collective: each rank makes a part, and
/// gets all.
[[nodiscard]] std::vector<SideView> views_of_sides(const Communicator& communicator,
                                                   const RayScene& ray_scene, const Scene& scene,
                                                   const ElementView& mesh,
                                                   std::span<const std::uint32_t> sides, int threads);

}  // namespace fluxel
