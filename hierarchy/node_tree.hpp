#pragma once

#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

#include "core/element.hpp"
#include "core/ranks.hpp"
#include "formfactor/pair_rule.hpp"
#include "scene/scene.hpp"
#include "subdivision/bisection.hpp"

namespace fluxel {

using NodeId = std::uint32_t;
inline constexpr NodeId kNoNode = std::numeric_limits<NodeId>::max();

/// A cone of directions.
struct Cone {
  glm::dvec3 axis{0};     ///< unit
  double half_angle = 0;  ///< [rad]; pi: all directions
};

/// Unit vectors in a piece's plane, perpendicular to each other.
struct PlaneAxes {
  glm::dvec3 u{0}, v{0};
};

/// A node of the hierarchy: one side of a piece or of a part of it ("face"), or above the pieces a cluster of
/// faces.
struct Node {
  /// Of a cluster: area and centroid of its faces together, `normal` the area-weighted mean of their normals
  /// (not unit).
  FlatShape shape;
  double radius = 0;     ///< of a sphere around the centroid that holds it [m]
  glm::dvec2 extent{0};  ///< of a face: how far it reaches from the centroid along its axes [m]
  NodeId parent = kNoNode;
  std::array<NodeId, 2> child{kNoNode, kNoNode};  ///< none: a leaf
  NodeId twin = kNoNode;    ///< of a face: the other side of the same part, where that is an unknown too
  std::uint32_t piece = 0;  ///< of a face
  bool front = true;        ///< of a face
  std::uint8_t halved = 0;  ///< of a face that has children: the edge of the front's outline that was cut

  [[nodiscard]] bool is_leaf() const { return child[0] == kNoNode; }
};

/// The leaves of an element's sides; kNoNode for a side that is no unknown.
struct ElementNodes {
  NodeId front = kNoNode, back = kNoNode;
};

/// A leaf to be halved, across the middle of an edge of its outline (see bisect).
struct Halving {
  NodeId leaf = kNoNode;
  std::uint32_t edge = 0;

  bool operator==(const Halving&) const = default;
};

/// A face that has been drawn, and the chance that it had.
struct DrawnFace {
  NodeId face = kNoNode;
  double chance = 1;
};

/// Ways by which clusters exchange light: along each axis of space to either side, and within themselves.
inline constexpr std::size_t kDirections = 6, kWithin = kDirections, kWays = kDirections + 1;

/// Of a cluster's child: its part of what the cluster exchanges by each way.
using WayShares = std::array<double, kWays>;

/// What goes by which ways, in parts that sum to 1.
struct WayParts {
  std::array<std::size_t, 3> way{kWithin, kWithin, kWithin};
  std::array<double, 3> part{1, 0, 0};
};

/// The way back.
[[nodiscard]] constexpr std::size_t opposite(std::size_t way) { return way == kWithin ? way : way ^ 1; }

/// Of light along a direction of any length, mostly by the axis that is nearest; of none within.
[[nodiscard]] WayParts way_parts(const glm::dvec3& direction);

/// The bisection trees of all pieces, a tree for each side that is an unknown, grown where it is asked for,
/// and above them a hierarchy of clusters. The numbers of nodes depend on the scene and on what has been
/// split in which step, never on ranks; a child's is larger than its parent's.
class NodeTree {
 public:
  /// The scene must outlive this. Collective: made by one rank of each host; its ranks hold together what
  /// they do not split themselves.
  explicit NodeTree(const Scene& scene, int threads = 1, const Ranks& ranks = {});

  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  [[nodiscard]] const Node& operator[](NodeId id) const { return nodes_[id]; }
  [[nodiscard]] bool is_cluster(NodeId id) const { return id < clusters_; }
  [[nodiscard]] std::size_t clusters() const { return clusters_; }

  /// Counter-clockwise about the side's normal; faces only.
  [[nodiscard]] Outline<glm::dvec3> outline(NodeId id) const {
    if (id >= whole_) return outlines_[id - whole_];
    const Outline<glm::dvec3>& of_front = scene_.pieces[nodes_[id].piece].outline;
    return nodes_[id].front ? of_front : reversed(of_front);
  }
  /// The same for all faces of a piece.
  [[nodiscard]] const PlaneAxes& axes(NodeId id) const { return axes_[nodes_[id].piece]; }
  /// The extent of a child over a face's own.
  [[nodiscard]] glm::dvec2 shrinking(NodeId id, NodeId child) const {
    return nodes_[child].extent / nodes_[id].extent;
  }
  /// Clusters and the faces of whole pieces, which come first.
  [[nodiscard]] std::size_t whole() const { return whole_; }

  /// Of a node that is not the root: by area as long as nothing better is known (see cluster_shares).
  [[nodiscard]] WayShares shares(NodeId child) const {
    if (!shares_.empty()) return shares_[child];
    WayShares by_area;
    by_area.fill(nodes_[child].shape.area / nodes_[nodes_[child].parent].shape.area);
    return by_area;
  }
  /// An entry for each of whole().
  void set_shares(std::vector<WayShares> shares) { shares_ = std::move(shares); }

  /// Those of whole pieces.
  [[nodiscard]] std::span<const NodeId> faces_of_cluster(NodeId id) const {
    return std::span(ordered_faces_).subspan(ranges_[id].first, ranges_[id].count);
  }
  [[nodiscard]] std::size_t leaves() const { return (nodes_.size() - whole_) / 2 + whole_ - clusters_; }

  /// A point of a face's plane from its centroid along the axes, over the extents.
  [[nodiscard]] glm::dvec2 place(NodeId id, const glm::dvec3& point) const {
    return along_axes(id, point - nodes_[id].shape.centroid) / nodes_[id].extent;
  }
  /// Of the places of all points of a face.
  [[nodiscard]] glm::dmat2 covariance(NodeId id) const;
  [[nodiscard]] glm::dvec2 along_axes(NodeId id, const glm::dvec3& d) const {
    return {glm::dot(d, axes(id).u), glm::dot(d, axes(id).v)};
  }

  /// Of a face.
  [[nodiscard]] MaterialId material_id(NodeId id) const {
    return scene_.patch(scene_.pieces[nodes_[id].piece].patch).material;
  }
  [[nodiscard]] const Material& material(NodeId id) const { return scene_.materials[index(material_id(id))]; }

  [[nodiscard]] Rgb emission(NodeId id) const {  ///< of a face [W/m2]
    return nodes_[id].front ? material(id).E : material(id).back_exitance();
  }

  /// The normals of a cluster's faces.
  [[nodiscard]] const Cone& cone(NodeId id) const { return cones_[id]; }

  /// The face of a whole piece; kNoNode where the side is no unknown, or there is no such piece.
  [[nodiscard]] NodeId face(std::size_t piece, bool front) const {
    return piece < faces_.size() / 2 ? faces_[2 * piece + (front ? 0 : 1)] : kNoNode;
  }

  /// A face of the node, or the node itself, with a chance of its share of the area; `u` of [0, 1) chooses
  /// and is left as random as it was.
  [[nodiscard]] NodeId random_face(NodeId id, double& u) const;

  /// The same with a chance that is the larger, the larger the face looks from a point: about in proportion
  /// to area over squared distance, so that a few near faces are found among many.
  [[nodiscard]] DrawnFace draw_face(NodeId id, const glm::dvec3& from, double& u) const;

  /// Of the front's outline.
  [[nodiscard]] double edge_length(NodeId id, std::uint32_t edge) const {
    const Outline<glm::dvec3> of = front_outline(id);
    return glm::distance(of.corner[edge], of.corner[(edge + 1) % of.corners]);
  }
  /// The edge whose middle parts a face into halves that are as compact as can be.
  [[nodiscard]] std::uint32_t longest_edge(NodeId id) const { return edge_to_bisect(front_outline(id)); }

  /// Halves faces that are leaves, each named once, ascending, and their twins; of twins that are both named
  /// as the first says.
  void split(std::span<const Halving> leaves);

  /// What has been halved since the beginning, in order, of twins the front: the tree made anew by
  /// halve_again has the same numbers.
  [[nodiscard]] std::vector<Halving> halvings() const;
  /// False, with the tree left in between, where one of them is no leaf of a face or has no such edge.
  [[nodiscard]] bool halve_again(std::span<const Halving> halvings);

  /// Whether the point of the piece's plane lies in the first child of a face that has been halved.
  [[nodiscard]] bool in_first_child(NodeId face, const glm::dvec3& point) const {
    return lines_[line_of_[face]].first.holds(point);
  }
  /// The leaf below a face that a point of the piece's plane lies on; none of none.
  [[nodiscard]] NodeId leaf_below(NodeId face, const glm::dvec3& point) const;

  /// The leaves as elements: all pieces in their order, the leaves of each depth first.
  [[nodiscard]] ElementMesh elements() const;
  /// The leaves of each of these elements.
  [[nodiscard]] std::vector<ElementNodes> element_nodes() const;

  [[nodiscard]] const Scene& scene() const { return scene_; }

 private:
  void build();
  void add_face(const Outline<glm::dvec3>& outline, std::uint32_t piece, bool front, NodeId parent);
  NodeId add_half(const Outline<glm::dvec3>& outline, std::uint32_t piece, bool front, NodeId parent);
  void add_faces_of(std::uint32_t piece);
  void add_clusters();
  void make_room(std::size_t halvings);
  void halve(NodeId id, std::uint32_t edge);
  [[nodiscard]] Outline<glm::dvec3> front_outline(NodeId id) const;
  template <class Visit>
  void visit_parts(const Visit& visit) const;

  /// Where a face has been halved, side by side for those who look for a point's leaf.
  struct DividingLine {
    HalfPlane first;
    std::array<NodeId, 2> child;
  };
  struct FaceRange {
    std::uint32_t first, count;
  };
  static constexpr std::uint32_t kNoLine = 0xFFFFFFFFu;

  const Scene& scene_;
  int threads_;
  std::vector<Node> nodes_;  // clusters first, the root 0, then faces
  std::size_t clusters_ = 0;
  std::size_t whole_ = 0;                      // clusters and the faces of whole pieces
  std::vector<Outline<glm::dvec3>> outlines_;  // of halves; whole pieces have their own
  std::vector<DividingLine> lines_;
  std::vector<std::uint32_t> line_of_;  // of all nodes
  std::vector<Cone> cones_;             // of clusters
  std::vector<WayShares> shares_;       // of whole_, or none
  std::vector<NodeId> faces_;           // front and back of each piece
  std::vector<NodeId> ordered_faces_;   // of whole pieces, those of each cluster together
  std::vector<FaceRange> ranges_;       // of clusters in ordered_faces_
  std::vector<PlaneAxes> axes_;         // of each piece
};

}  // namespace fluxel
