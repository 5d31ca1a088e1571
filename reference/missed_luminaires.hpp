#pragma once

#include "scene/scene.hpp"

namespace fluxel {

/// Throws InputError where the scene has a luminaire that is a point or a line and a surface that mirrors,
/// refracts or transmits straight: paths do not find the light that goes from the one by the other.
void refuse_missed_luminaires(const Scene& scene);

}  // namespace fluxel
