#pragma once

#include <vector>

#include "scene/readers/gltf_file.hpp"
#include "scene/readers/gltf_materials.hpp"
#include "scene/readers/gltf_meshes.hpp"

namespace fluxel {

/// Multiplies reflectances and emissions by the images that materials name: of each triangle its mean over
/// the image (GltfTriangles::rho), of what a material emits the mean over all its triangles, by their area in
/// the image. One image at a time is held decoded. Throws InputError with the JSON path.
void apply_gltf_textures(const GltfFile& gltf, const TextLookup& lookup, GltfMeshes& meshes,
                         std::vector<GltfMaterial>& materials);

}  // namespace fluxel
