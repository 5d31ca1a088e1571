#pragma once

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <vector>

#include "scene/readers/gltf_file.hpp"

namespace fluxel {

/// A node of the scene, and what takes its coordinates to world metres.
struct GltfNode {
  std::size_t node = 0;
  glm::dmat4 to_world{1};
};

/// The nodes of the default scene (without one the first; without any all nodes), parents before their
/// children, in the order of the file. Throws InputError for nodes with two parents or that are their own
/// ancestors, and for transforms that are not affine.
[[nodiscard]] std::vector<GltfNode> place_gltf_nodes(const GltfFile& gltf);

/// The direction that the node's axis points to, as a unit vector of the world. Throws InputError where the
/// node's scale leaves none.
[[nodiscard]] glm::dvec3 node_direction(const GltfFile& gltf, const GltfNode& node, const glm::dvec3& axis);

}  // namespace fluxel
