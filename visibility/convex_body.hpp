#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "scene/scene.hpp"
#include "visibility/box_tree.hpp"

namespace fluxel {

/// Patches that stand in the way as one, in single precision: a convex polygon, of a patch or of several that
/// share whole edges in one plane, or the closed surface of a convex body. What passes none of a polygon's
/// edges on the outer side, and crosses its plane, meets one of its patches; what passes a body's outline on
/// the inner side, from a point outside to one behind, meets a face that looks to the point.
struct ConvexBody {
  static constexpr std::size_t kMaxCorners = 8, kMaxFaces = 8, kMaxEdges = 16;

  std::array<glm::vec3, kMaxCorners> corner{};
  std::uint32_t corners = 0;
  std::uint32_t faces = 0;   ///< a polygon has two, which look to either side
  std::uint32_t planes = 0;  ///< of the faces; a polygon's second face has the first one's
  std::uint32_t edges = 0;
  glm::vec3 centre{0};
  float radius = 0;   ///< [m], of the corners around the centre
  float breadth = 0;  ///< [m], half the side of a square as large as its largest face
  /// A corner of each face, and its normal, outwards.
  std::array<glm::vec3, kMaxFaces> base{}, normal{};
  /// Ends of the edges, one coordinate an array. The left face has the edge counter-clockwise; the right one
  /// is at its other side.
  struct Ends {
    std::array<float, kMaxEdges> x{}, y{}, z{};
  };
  alignas(64) Ends from;
  alignas(64) Ends to;
  /// By face: bits of the edges that it is left of, and right of.
  std::array<std::uint32_t, kMaxFaces> left{}, right{};

  [[nodiscard]] bool is_flat() const { return planes == 1; }
  [[nodiscard]] std::uint32_t all_faces() const { return (1u << faces) - 1; }
};

/// All of the scene's patches as convex bodies, in a hierarchy of boxes.
class BodyTree {
 public:
  explicit BodyTree(const Scene& scene);

  /// In the order of the hierarchy.
  [[nodiscard]] const std::vector<ConvexBody>& bodies() const { return bodies_; }

  /// Calls visit(body) for the bodies of all leaves that pass enter(low, high), with corners of boxes, as do
  /// the nodes above them, until it returns true; returns whether it did.
  template <class Enter, class Visit>
  bool search(const Enter& enter, const Visit& visit) const;

 private:
  struct Node {
    glm::vec3 low{0}, high{0};  // rounded; who searches allows for it
    std::uint32_t first = 0, count = 0;
  };

  std::vector<ConvexBody> bodies_;
  std::vector<Node> nodes_;  // as BoxTree's
};

template <class Enter, class Visit>
bool BodyTree::search(const Enter& enter, const Visit& visit) const {
  return search_boxes(
      nodes_, [&](const Node& node) { return enter(node.low, node.high); }, visit);
}

}  // namespace fluxel
