#pragma once

#include "hierarchy/irradiance_source.hpp"
#include "method/problem.hpp"
#include "method/solution.hpp"

namespace fluxel {

/// Whether a run writes a light map.
[[nodiscard]] bool bakes_light_map(const Options& options);

/// Collective, before a run's work: throws AgreedError where a light map would have too many texels.
void require_light_map_fits(const Problem& problem);

/// Collective: gathers light at texels of Options::lightmap_texel over all surfaces (see LightMapPoints) from
/// a finished solution; into the root's solution. `target`: see allowed_noise.
void bake_light_map(const Problem& problem, IrradianceSource& source, double target, Solution& solution);

}  // namespace fluxel
