#pragma once

#include "visibility/cuda/nearest_hit.hpp"

namespace fluxel::cuda {

/// What FirstSide knows of a patch, as bits: which sides send and receive, whether one emits, whether others
/// have taken area from it, whether it covers an emitter close behind it, and whether its material has two
/// sides.
inline constexpr std::uint8_t kActiveFront = 1, kActiveBack = 2, kEmitter = 4, kCovered = 8,
                              kCoversEmitter = 16, kTwoSided = 32;

/// As fluxel::MetSide, of which this is the device's part; the patch is its number, kNoHit for none.
struct SideHit {
  std::uint32_t patch = kNoHit;
  bool front = true, active = false;
  double t = 0;
  Double3 normal{0, 0, 0};  ///< of the side
};

FLUXEL_PORTABLE inline SideHit side_of(const ExactPatch& patch, std::uint8_t flags, double t,
                                       const Double3& direction) {
  const bool front = dot(patch.normal, direction) < 0;
  return {patch.number, front, (flags & (front ? kActiveFront : kActiveBack)) != 0, t,
          front ? patch.normal : -1.0 * patch.normal};
}

/// Of the patches that a ray meets up to a place, the one that goes before the others: see FirstSide.
class FrontmostSide {
 public:
  FLUXEL_PORTABLE FrontmostSide(const std::uint8_t* flags, const Double3& from, const Double3& along,
                                double far)
      : flags_(flags), from_(from), along_(along), far_(far) {}

  FLUXEL_PORTABLE void look_at(const ExactPatch& patch, std::uint32_t place) {
    if (!ray_meets(polygon_of(patch), from_, along_)) return;
    const std::uint8_t flags = flags_[patch.number];
    const std::uint64_t rank = (side_of(patch, flags, 0, along_).active ? 0 : std::uint64_t{4} << 32) |
                               ((flags & kCoversEmitter) != 0 ? 0 : std::uint64_t{2} << 32) |
                               ((flags & kEmitter) != 0 ? 0 : std::uint64_t{1} << 32) | patch.number;
    if (rank > rank_ || plane_parameter(polygon_of(patch), from_, along_) > far_) return;
    rank_ = rank;
    place_ = place;
  }

  [[nodiscard]] FLUXEL_PORTABLE double far() const { return far_; }
  [[nodiscard]] FLUXEL_PORTABLE std::uint32_t place() const { return place_; }

 private:
  const std::uint8_t* flags_;
  Double3 from_, along_;
  double far_;
  std::uint64_t rank_ = ~std::uint64_t{0};
  std::uint32_t place_ = kNoHit;
};

/// Which side a ray ends on: as FirstSide::meet.
template <class Scene>
FLUXEL_PORTABLE SideHit first_side(const Scene& scene, const std::uint8_t* flags, const Ray& ray) {
  const NearestHit nearest = nearest_hit(scene, ray);
  if (nearest.patch == kNoHit) return {};
  const ExactPatch& hit = scene.exact[nearest.patch];
  const std::uint8_t of_hit = flags[hit.number];
  const SideHit first = side_of(hit, of_hit, nearest.t, ray.direction);
  if ((first.active || (of_hit & kTwoSided) != 0) && (of_hit & kCovered) == 0) return first;
  const double cosine = std::fabs(dot(hit.normal, ray.direction));
  const TracedRay as_traced = traced(scene, ray);
  FrontmostSide frontmost(flags, widen(as_traced.from), widen(as_traced.along),
                          nearest.t - as_traced.entry + 2 * static_cast<double>(scene.lift) / cosine);
  walk_along(scene, as_traced.from, as_traced.along, frontmost);
  if (frontmost.place() == kNoHit) return first;
  const ExactPatch& best = scene.exact[frontmost.place()];
  return side_of(best, flags[best.number], plane_parameter(polygon_of(best), ray.origin, ray.direction),
                 ray.direction);
}

}  // namespace fluxel::cuda
