#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/element.hpp"
#include "hierarchy/gather.hpp"
#include "hierarchy/node_tree.hpp"

namespace fluxel {

/// The face of the tree that each unknown of a mesh lies on; kNoNode of sides that are none. Each of the
/// mesh's elements lies on one piece.
[[nodiscard]] std::vector<NodeId> faces_of_unknowns(const NodeTree& tree, const ElementView& mesh);

/// Vertices that the elements of one side of a piece share, and none with others: light bleeds from no side
/// of a wall to the other.
struct MeshVertices {
  std::vector<glm::vec3> positions;  ///< [m]
  /// Where each is looked at: a little towards the middle of the elements around, so that one at the foot of
  /// a wall lies on the side of it that its elements are on.
  std::vector<GatherPoint> points;
  std::vector<std::array<std::uint32_t, 4>> corners;  ///< of each unknown: those of its element's outline
};

/// `faces`: see faces_of_unknowns.
[[nodiscard]] MeshVertices vertices_of(const ElementView& mesh, const std::vector<NodeId>& faces);

}  // namespace fluxel
