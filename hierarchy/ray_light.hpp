#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

#include "core/rgb.hpp"
#include "formfactor/even_points.hpp"
#include "formfactor/free_segments.hpp"
#include "hierarchy/emitter_draw.hpp"
#include "hierarchy/node_tree.hpp"
#include "optics/luminaire_light.hpp"
#include "subdivision/piece_finder.hpp"
#include "visibility/first_side.hpp"

namespace fluxel {

/// The leaf that a ray ends on.
struct MetLeaf {
  NodeId leaf = kNoNode;  ///< none: the ray leaves the scene, or ends where no side is an unknown
  glm::dvec3 point{0};
};

/// How many rays tell what falls on a point or a node.
struct RayNumbers {
  int hemisphere = 64;  ///< cosine-distributed
  int lamps = 16;       ///< to drawn points of what emits
};

/// What a ray to a drawn point of an emitter tells, whether or not something stands between.
struct OpenRay {
  Rgb light{0};           ///< that it adds to the irradiance [W/m2]
  double met_square = 0;  ///< its mean over draws: the mean square of what a ray of the hemisphere adds by
                          ///< emission, mean of the colours [W2/m4]
};

/// What rays bring of light that is emitted, apart from what is reflected: by rays to drawn points of
/// emitters and by those of the hemisphere that end on them, weighted by the density of both (Veach & Guibas
/// 1995). Queries may run from many threads at once.
class RayLight {
 public:
  /// Collective. What is given must outlive this; the tree may be split.
  RayLight(const RayScene& ray_scene, const NodeTree& tree, int threads = 1, const Ranks& ranks = {});

  /// A point of a face.
  [[nodiscard]] ReceivingPoint receiving(NodeId face, const glm::dvec3& point) const {
    return {point, tree_[face].shape.normal, emitters_.region_of(face)};
  }

  /// A ray of the hemisphere, by two numbers of [0, 1).
  [[nodiscard]] Ray hemisphere_ray(const ReceivingPoint& at, double u, double v) const;
  /// Where a ray ends that is known to meet that first.
  [[nodiscard]] MetLeaf end_of(const Ray& ray, const PatchHit& hit) const;
  /// Where a ray of the hemisphere ends.
  [[nodiscard]] MetLeaf first_met(const Ray& ray) const {
    return end_of(ray, ray_scene_.first_hit(ray.origin, ray.direction));
  }

  /// What a ray of the hemisphere that ends there adds to the irradiance by emission, as one of `numbers`;
  /// `density`: of its face, and there, that rays to emitters have [1/m2].
  template <class Density>
  [[nodiscard]] Rgb emitted(const ReceivingPoint& at, const MetLeaf& met, const RayNumbers& numbers,
                            const Density& density) const {
    const NodeId face = face_of_piece(met.leaf);
    if (!emitters_.emits(face)) return Rgb(0);
    const double K = kernel(at, met.point, tree_[face].shape.normal);
    const double both = numbers.hemisphere * K + numbers.lamps * density(face, met.point);
    return both > 0 ? tree_.emission(face) * (K / both) : Rgb(0);
  }

  /// Rays to drawn points of emitters, from points that are added one by one; `add` is called with the number
  /// of a point, in their order, and what it adds to the irradiance.
  template <class Add>
  class Lamps;

  [[nodiscard]] const NodeTree& tree() const { return tree_; }
  [[nodiscard]] const EmitterDraw& emitters() const { return emitters_; }
  [[nodiscard]] const LuminaireLight& luminaires() const { return luminaires_; }

 private:
  /// Over pi r^2 both cosines, zero where they do not face each other [1/m2].
  [[nodiscard]] static double kernel(const ReceivingPoint& at, const glm::dvec3& of,
                                     const glm::dvec3& normal);
  [[nodiscard]] NodeId face_of_piece(NodeId leaf) const {
    return tree_.face(tree_[leaf].piece, tree_[leaf].front);
  }

  const RayScene& ray_scene_;
  const NodeTree& tree_;
  FirstSide first_side_;
  PieceFinder pieces_;
  EmitterDraw emitters_;
  LuminaireLight luminaires_;
};

template <class Add>
class RayLight::Lamps {
 public:
  Lamps(const RayLight& light, const RayNumbers& numbers, Add add)
      : light_(light), numbers_(numbers), add_(std::move(add)) {}

  /// To what was drawn from there.
  OpenRay point(std::uint32_t number, const ReceivingPoint& at, const DrawnEmitter& drawn) {
    const glm::dvec3& normal = light_.tree_[drawn.face].shape.normal;
    const double K = kernel(at, drawn.point, normal);
    if (!(K > 0)) return {};
    const Rgb light =
        light_.tree_.emission(drawn.face) * (K / (numbers_.hemisphere * K + numbers_.lamps * drawn.density));
    segments_[count_] = {drawn.point, normal, at.position, at.normal};
    waiting_[count_++] = {number, light};
    if (count_ == segments_.size()) trace();
    const double met = numbers_.hemisphere * mean_of_colours(light);
    return {light, K / drawn.density * met * met};
  }

  /// After the last point. Returns the rays there were.
  std::uint64_t finish() {
    trace();
    return rays_;
  }

 private:
  struct Waiting {
    std::uint32_t number;
    Rgb light;
  };
  void trace() {
    if (count_ == 0) return;
    rays_ += count_;
    const std::uint32_t free = free_segments(light_.ray_scene_, std::span(segments_).first(count_));
    for (std::size_t k = 0; k < count_; ++k)
      if ((free >> k & 1u) != 0) add_(waiting_[k].number, waiting_[k].light);
    count_ = 0;
  }

  const RayLight& light_;
  RayNumbers numbers_;
  Add add_;
  std::array<SurfaceSegment, RayPacket::kSize> segments_;
  std::array<Waiting, RayPacket::kSize> waiting_;
  std::size_t count_ = 0;
  std::uint64_t rays_ = 0;
};

}  // namespace fluxel
