#pragma once

#include "hierarchy/irradiance_source.hpp"
#include "method/problem.hpp"
#include "method/solution.hpp"

namespace fluxel {

/// Whether a run writes a mesh of other faces than its elements.
[[nodiscard]] bool bakes_mesh(const Options& options);

/// Collective, before a run's work: throws AgreedError where such a mesh would have too many faces.
void require_mesh_fits(const Problem& problem);

/// Collective: subdivides all surfaces to edges of Options::mesh_max_edge, and gathers light at the faces'
/// centroids (for solution.vtu) and at their vertices (for files of GLB) from a finished solution; into the
/// root's solution. `target`: see allowed_noise.
void bake_mesh(const Problem& problem, IrradianceSource& source, double target, Solution& solution);

}  // namespace fluxel
