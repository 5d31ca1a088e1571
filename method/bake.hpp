#pragma once

#include "hierarchy/irradiance_source.hpp"
#include "method/problem.hpp"
#include "method/solution.hpp"

namespace fluxel {

/// Whether a run gathers light for a mesh or for a light map.
[[nodiscard]] bool bakes(const Options& options);

/// Collective, before a run's work: throws AgreedError where what is baked would be too large.
void require_bakeable(const Problem& problem);

/// Collective: gathers from a finished solution what bakes() says; into the root's solution. A signal that
/// asks the run to stop or to end leaves out what is not yet done. `target`: see allowed_noise.
void bake(const Problem& problem, IrradianceSource& source, double target, Solution& solution);

}  // namespace fluxel
