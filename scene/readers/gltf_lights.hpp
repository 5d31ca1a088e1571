#pragma once

#include <vector>

#include "scene/readers/gltf_file.hpp"
#include "scene/readers/gltf_nodes.hpp"
#include "scene/scene_input.hpp"

namespace fluxel {

/// The far field of a spot of 1 cd (KHR_lights_punctual, Khronos Group 2019): full within the inner cone,
/// nothing outside the outer one, between them the square of what is linear in the cosine. Angles from the
/// axis [rad], inner <= outer. Between tabulated angles within 0.02 % of the flux.
[[nodiscard]] IntensityTable spot_intensity(double inner, double outer);

/// Adds the point lights and the spots (KHR_lights_punctual) of the nodes, as luminaires [cd]. Throws
/// InputError for directional lights and for cones that do not fit, with the JSON path.
void add_gltf_lights(const GltfFile& gltf, const std::vector<GltfNode>& nodes, SceneInput& scene);

}  // namespace fluxel
