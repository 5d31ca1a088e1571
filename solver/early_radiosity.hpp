#pragma once

#include <functional>
#include <span>

#include "solver/radiosity_operator.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

/// Called after each shot with an early radiosity [W/m2] of this rank's unknowns and what is left to shoot
/// over what has been emitted; false ends.
using ShotObserver = std::function<bool(std::span<const Rgb> B, double left)>;

/// Shoots light from where most of it is (Southwell's relaxation, see solver/iteration) until the observer
/// ends it. What has not been shot yet is shown as an even ambient light (Cohen, Chen, Wallace & Greenberg
/// 1988, section 5.2), so that early pictures are not too dark.
void shoot_early_radiosity(RadiosityOperator& F, const Unknowns& unknowns, const ShotObserver& observer);

}  // namespace fluxel
