#pragma once

#include "scene/scene.hpp"
#include "scene/scene_input.hpp"

namespace fluxel {

/// Makes the patches: coordinates [m] recentred on the middle of the bounding box; a quad that is a
/// parallelogram within 1e-6 of its longest edge stays one, other polygons become triangles; a quad that is
/// not planar is split between its first and third corner, larger polygons that are not planar in their mean
/// plane; faces of less area than 1e-14 of the squared diagonal of the bounding box are dropped. Materials
/// get their exitance (from a radiance by the factor pi, in thermal runs from their heat) and sides; faces of
/// textured ones may get others (face_materials.hpp). Fills
/// all of Scene but the pieces and the statistics on topology. Throws InputError where no face with an area
/// is left, or where coordinates are too large or the whole too small for single-precision rays.
[[nodiscard]] Scene to_patches(const SceneInput& input, const SceneSettings& settings);

}  // namespace fluxel
