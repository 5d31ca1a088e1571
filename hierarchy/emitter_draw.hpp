#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "hierarchy/node_tree.hpp"

namespace fluxel {

/// A point of an emitting face of a whole piece, and the density with which it was drawn.
struct DrawnEmitter {
  NodeId face = kNoNode;
  glm::dvec3 point{0};
  double density = 0;  ///< [1/m2]
};

/// Draws points of what emits, as seen from another point: down the tree by power over squared distance
/// (Conty Estevez & Kulla 2018), so that of many lamps the near ones are found.
class EmitterDraw {
 public:
  /// Must outlive this; may be split.
  explicit EmitterDraw(const NodeTree& tree);

  [[nodiscard]] bool empty() const { return power_.empty() || !(power_[0] > 0); }
  [[nodiscard]] bool emits(NodeId face_of_piece) const { return power_[face_of_piece] > 0; }

  /// By three numbers of [0, 1). There is something to draw.
  [[nodiscard]] DrawnEmitter draw(const glm::dvec3& from, double choice, double u, double v) const;
  /// Of any point of the face of a whole piece [1/m2].
  [[nodiscard]] double density(NodeId face, const glm::dvec3& from) const;

 private:
  [[nodiscard]] double share(NodeId child, NodeId sibling, const glm::dvec3& from) const;

  const NodeTree& tree_;
  std::vector<double> power_;  // magnitude of what clusters and the faces of whole pieces emit [W]
};

}  // namespace fluxel
