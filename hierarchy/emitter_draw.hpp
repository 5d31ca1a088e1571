#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/ranks.hpp"
#include "hierarchy/node_tree.hpp"
#include "hierarchy/solid_angle.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// A point of an emitting face of a whole piece, and the density with which it was drawn.
struct DrawnEmitter {
  NodeId face = kNoNode;
  glm::dvec3 point{0};
  double density = 0;  ///< [1/m2]
};

/// A part of the scene from which emitters are seen about alike.
using RegionId = std::uint32_t;

/// A point of a side that light falls on.
struct ReceivingPoint {
  glm::dvec3 position{0};
  glm::dvec3 normal{0};  ///< unit, of the side
  RegionId region = 0;
};

/// Draws points of what emits, as seen from another point: down the tree by power over squared distance
/// (Conty Estevez & Kulla 2018), so that of many lamps the near ones are found, times the root of how much of
/// them is seen from around the point (the root makes the variance least; lamps of other rooms are not asked
/// for nothing, as in the clusterings of Wang et al. 2021 that learn visibility). Of a face that is near,
/// each direction to it is as likely as every other.
class EmitterDraw {
 public:
  /// By rays between regions and groups of emitters. Collective: made by one rank of each host, for all of
  /// its ranks. The tree must outlive this, and may be split.
  EmitterDraw(const NodeTree& tree, const RayScene& ray_scene, int threads = 1, const Ranks& ranks = {});

  [[nodiscard]] bool empty() const { return power_.empty() || !(power_[0] > 0); }
  [[nodiscard]] bool emits(NodeId face_of_piece) const { return power_[face_of_piece] > 0; }
  /// Of any face.
  [[nodiscard]] RegionId region_of(NodeId face) const;

  /// By three numbers of [0, 1). There is something to draw.
  [[nodiscard]] DrawnEmitter draw(const ReceivingPoint& at, double choice, double u, double v) const;
  /// That a point is drawn of the face of a whole piece.
  [[nodiscard]] double chance(NodeId face, const ReceivingPoint& at) const;
  /// Of a point of it [1/m2].
  [[nodiscard]] double density(NodeId face, const glm::dvec3& of, const ReceivingPoint& at) const;

 private:
  friend class EmitterView;

  [[nodiscard]] std::optional<SeenFace> as_near(NodeId face, const glm::dvec3& from) const;
  [[nodiscard]] double density_on(NodeId face, const std::optional<SeenFace>& near, const glm::dvec3& of,
                                  const glm::dvec3& from) const;
  [[nodiscard]] double share(NodeId child, NodeId sibling, const ReceivingPoint& at) const;
  [[nodiscard]] double most_facing(NodeId id, const ReceivingPoint& at) const;
  [[nodiscard]] double seen_from(NodeId id, RegionId region) const;
  [[nodiscard]] double apparent_power(NodeId id, const ReceivingPoint& at) const;
  [[nodiscard]] DrawnEmitter draw_below(NodeId id, double chance, const ReceivingPoint& at, double choice,
                                        double u, double v) const;
  [[nodiscard]] double density_on(NodeId face, const glm::dvec3& of, const glm::dvec3& from) const {
    return density_on(face, as_near(face, from), of, from);
  }
  [[nodiscard]] std::vector<NodeId> make_groups();
  [[nodiscard]] std::vector<NodeId> make_regions();
  void build(const RayScene& ray_scene, int threads);
  void learn(const RayScene& ray_scene, std::span<const NodeId> groups, NodeId region,
             std::span<float> seen) const;

  static constexpr std::uint32_t kNoColumn = 0xFFFFFFFFu;

  const NodeTree& tree_;
  std::vector<double> power_;          // magnitude of what clusters and the faces of whole pieces emit [W]
  std::vector<Cone> cones_;            // likewise: of the normals of what emits
  std::vector<RegionId> region_;       // likewise; of clusters above regions any
  std::vector<std::uint32_t> column_;  // likewise: in seen_; none below the groups
  std::size_t columns_ = 0;
  std::vector<float> seen_;  // the root of how much is seen, a row for each region
};

}  // namespace fluxel
