#pragma once

#include "optics/emitters.hpp"

namespace fluxel {

/// What the light that leaves a side of a patch is made of, as paths ask that go backwards: rho and mirror of
/// what comes to this side, but shares of what is transmitted or refracted of what comes to the other, which
/// is nothing where that side is not active. Active: light may leave here.
[[nodiscard]] SideLight leaving_side(const Scene& scene, PatchId id, bool front);

}  // namespace fluxel
