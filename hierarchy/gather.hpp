#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/rgb.hpp"
#include "hierarchy/link_operator.hpp"
#include "hierarchy/node_tree.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// A point of a face.
struct GatherPoint {
  NodeId face = kNoNode;
  glm::dvec3 position{0};
  double weight = 1;  ///< of its irradiance in what is asked for; the less, the larger its error may be
};

/// Where light that falls on a point comes from.
enum class LightFrom {
  everywhere,
  emission,   ///< straight from emitters
  reflection  ///< the rest
};

/// What, and how well.
struct GatherGoal {
  double error = 5e-3;     ///< by rays, of a point's irradiance by one sender, relative to the mean radiosity
  Rgb mean_radiosity{0};   ///< [W/m2]
  std::uint64_t seed = 0;  ///< of the rays
  LightFrom light = LightFrom::everywhere;
};

/// How many rays a point's light is worth for each W/m2 that it varies by with the ray (standard deviation):
/// of a face of this mean reflectance, and of a point of this weight.
[[nodiscard]] double rays_a_spread(const GatherGoal& goal, double rho, double weight);

/// A place of a face that a point sees from close by: of the light there more is worth knowing than the
/// linear functions of leaves.
struct NearPlace {
  std::uint32_t point = 0;   ///< its number
  std::uint32_t number = 0;  ///< among the places of one sender of this point
  GatherPoint at;            ///< on a leaf
  double F = 0;              ///< form factor from the point that the place stands for
  Rgb B{0};                  ///< radiosity that has been taken there [W/m2]
};

/// The irradiance of points from the links of their leaf and all nodes above it, with the form factor of the
/// point itself and rays of its own where something stands between: the final gather of hierarchical
/// radiosity (Lischinski, Tampieri & Greenberg 1993).
class Gatherer {
 public:
  /// All must outlive this; `B`, of the light that is gathered, and `slopes` (see slopes_of_leaves) have an
  /// entry a node, slopes those of leaves.
  Gatherer(const RayScene& ray_scene, const NodeTree& tree, const LinkTable& table, std::span<const Rgb> B,
           std::span<const std::array<Rgb, 2>> slopes, const GatherGoal& goal);

  /// For the points of these numbers, at most PointGroup::kSize of one leaf: adds to `irradiance`, three
  /// whole numbers a point, what these links alone give, in units [W/m2]; sums of what different ranks' links
  /// give are the same in every order. Each `part` of many points has rays of its own. Where `near` is given,
  /// it gets places whose light is to be gathered too. Returns the rays.
  std::uint64_t gather(std::span<const GatherPoint> points, std::span<const std::uint32_t> of_leaf,
                       std::uint64_t part, std::span<std::uint64_t> irradiance,
                       std::vector<NearPlace>* near = nullptr) const;

  [[nodiscard]] double unit() const { return unit_; }
  [[nodiscard]] const GatherGoal& goal() const { return goal_; }

  /// What such a place sends of the light that is gathered, where this falls on it [W/m2].
  [[nodiscard]] Rgb sent(NodeId leaf, const Rgb& irradiance) const {
    const Rgb reflected = tree_.material(leaf).rho * irradiance;
    return goal_.light == LightFrom::everywhere ? tree_.emission(leaf) + reflected : reflected;
  }

 private:
  class PointGather;

  /// Of a node, what most links need, side by side.
  struct Sender {
    glm::dvec3 centroid, normal;
    double area;
    double variance;  ///< SecondMoments::trace
  };

  const RayScene& ray_scene_;
  const NodeTree& tree_;
  const LinkTable& table_;
  std::span<const Rgb> B_;
  std::span<const std::array<Rgb, 2>> slopes_;
  GatherGoal goal_;
  double unit_ = 1;
  std::vector<Sender> senders_;
};

}  // namespace fluxel
