#pragma once

#include <cstddef>
#include <vector>

#include "core/element.hpp"
#include "core/rgb.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// What luminaires bring straight to the elements [first, first + count): the mean irradiance [W/m2] of the
/// fronts, then, in scenes with two sides, of the backs; 0 of sides that are no unknowns. Empty where the
/// scene has no luminaire. By rays from points all over each element; depends on its number alone.
[[nodiscard]] std::vector<Rgb> first_light_of_elements(const RayScene& ray_scene, const ElementView& mesh,
                                                       std::size_t first, std::size_t count, bool two_sided,
                                                       int threads);

}  // namespace fluxel
