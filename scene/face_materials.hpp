#pragma once

#include <string>
#include <vector>

#include "scene/scene_input.hpp"

namespace fluxel {

/// Gives each material with a texture the mean of its faces' reflectances, weighted by their areas: what its
/// surface reflects of uniform light. One without a face of some area keeps its reflectance.
void set_mean_reflectance(SceneInput& input);

/// Gives a material, and all of its faces, one reflectance in place of what a texture says.
void set_reflectance(MaterialId material, const Rgb& rho, SceneInput& input);

/// Materials for single faces (`--textures face`): of materials with a texture, the faces of more than 1e-4
/// of the area of all faces are sorted by their reflectance's distance from the material's mean, in steps of
/// 0.02 in each channel. Those of one step share a new material, `wood (face 12)` after the first of them,
/// which has the mean of their reflectances by area; those within half a step keep theirs, as smaller faces
/// do, which gets the mean of what is left. So no more is reflected of uniform light than before, nor less.
/// Adds to `materials`, which are those of the input, and to `notes`. Returns the material of each polygon.
[[nodiscard]] std::vector<MaterialId> split_by_reflectance(const SceneInput& input,
                                                           std::vector<Material>& materials,
                                                           std::vector<std::string>& notes);

}  // namespace fluxel
