#pragma once

#include <vector>

#include "scene/readers/gltf_file.hpp"
#include "scene/readers/gltf_nodes.hpp"
#include "scene/scene_input.hpp"

namespace fluxel {

/// Adds the perspective cameras of the nodes: named by the node, else by the camera, names that differ.
/// Throws InputError with the JSON path.
void add_gltf_cameras(const GltfFile& gltf, const std::vector<GltfNode>& nodes, SceneInput& scene);

}  // namespace fluxel
