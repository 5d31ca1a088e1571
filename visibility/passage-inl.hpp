// Whether an occluder lets the segments between two hulls pass: all, none or some. For the instruction set
// that is being compiled, as lanes-inl.hpp.
#if defined(FLUXEL_VISIBILITY_PASSAGE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef FLUXEL_VISIBILITY_PASSAGE_INL_HPP
#undef FLUXEL_VISIBILITY_PASSAGE_INL_HPP
#else
#define FLUXEL_VISIBILITY_PASSAGE_INL_HPP
#endif

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <span>

#include "visibility/lanes-inl.hpp"
#include "visibility/occluder.hpp"

HWY_BEFORE_NAMESPACE();
namespace fluxel::HWY_NAMESPACE {

/// All segments from a corner of one hull to a corner of another. A volume over an edge of an occluder is
/// linear in either end of the segment, so that its signs at these tell that of all segments between.
struct HullSegments {
  static constexpr std::size_t kMax = 64;
  alignas(64) std::array<float, kMax> from_x, from_y, from_z, to_x, to_y, to_z;
  std::size_t count = 0;  // 16, 32 or 64
  glm::vec3 from_centre{0}, to_centre{0};
  float from_radius = 0, to_radius = 0, longest = 0;  // [m]
};

inline void set_segments(std::span<const glm::vec3> from, std::span<const glm::vec3> to,
                         HullSegments& segments) {
  std::size_t k = 0;
  for (const glm::vec3& a : from) {
    for (const glm::vec3& b : to) {
      segments.from_x[k] = a.x, segments.from_y[k] = a.y, segments.from_z[k] = a.z;
      segments.to_x[k] = b.x, segments.to_y[k] = b.y, segments.to_z[k] = b.z;
      ++k;
    }
  }
  segments.count = k;
  // The corners that face each other in a rectangle or in a box.
  const auto centre = [](std::span<const glm::vec3> hull) {
    return 0.5f * (hull[0] + hull[hull.size() == 4 ? 2 : 7]);
  };
  segments.from_centre = centre(from);
  segments.to_centre = centre(to);
  segments.from_radius = glm::length(from[0] - segments.from_centre);
  segments.to_radius = glm::length(to[0] - segments.to_centre);
  segments.longest =
      glm::length(segments.to_centre - segments.from_centre) + segments.from_radius + segments.to_radius;
}

/// By how much an inequality in single precision has to hold to be certain, with u the rounding error of one
/// operation, E the scene's extent and R the distance of an occluder's corners from a ray's origin: a volume
/// over an edge and a ray of length q is known to (14 R + 4 E) u R q.
struct Margins {
  static constexpr float kUlp = 0x1p-24f;

  float from_height, to_height;  // [m], of the hulls over the occluder's plane
  float hull_volume;             // [m3], six times that over an edge and a hull's segment
  float ray_volume;              // [m3], six times that over an edge and a ray
};

/// Rounding of a point's height over a plane, from the plane's corner this far away [m].
inline float plane_margin(float distance, float extent) { return 6 * Margins::kUlp * (distance + extent); }

inline Margins margins(const Occluder& occluder, const HullSegments& segments, float extent) {
  constexpr float kUlp = Margins::kUlp;
  const float from =
      occluder.radius + segments.from_radius + glm::length(segments.from_centre - occluder.centre);
  const float to = occluder.radius + segments.to_radius + glm::length(segments.to_centre - occluder.centre);
  Margins margin{};
  // The hulls stand for points that were rounded.
  const float slack = 16 * kUlp * extent;
  margin.from_height = plane_margin(from, extent) + slack;
  margin.to_height = plane_margin(to, extent) + slack;
  margin.ray_volume = kUlp * (16 * from + 4 * extent) * from * segments.longest;
  const float size = std::max(from, segments.longest);
  margin.hull_volume = margin.ray_volume + 6 * slack * size * size;
  return margin;
}

enum class Passage { open, closed, divided };

/// Whether the occluder meets none of the segments between two hulls, cuts all, or neither is certain.
inline Passage passage(const Occluder& occluder, const HullSegments& segments, const Margins& margin) {
  const Float d;
  constexpr float kHuge = std::numeric_limits<float>::max();
  const Vec huge = hn::Set(d, kHuge), tiny = hn::Set(d, -kHuge);
  const Vec3 normal = set(d, occluder.normal), base = set(d, occluder.corner[0]);
  Vec lowest_from = huge, highest_from = tiny, lowest_to = huge, highest_to = tiny;
  Vec least[4] = {huge, huge, huge, huge}, most[4] = {tiny, tiny, tiny, tiny};  // by edge
  for (std::size_t k = 0; k < segments.count; k += hn::Lanes(d)) {
    const Vec3 from{hn::Load(d, &segments.from_x[k]), hn::Load(d, &segments.from_y[k]),
                    hn::Load(d, &segments.from_z[k])};
    const Vec3 to{hn::Load(d, &segments.to_x[k]), hn::Load(d, &segments.to_y[k]),
                  hn::Load(d, &segments.to_z[k])};
    const Vec from_height = dot(normal, from - base), to_height = dot(normal, to - base);
    lowest_from = hn::Min(lowest_from, from_height);
    highest_from = hn::Max(highest_from, from_height);
    lowest_to = hn::Min(lowest_to, to_height);
    highest_to = hn::Max(highest_to, to_height);
    const Vec3 along = to - from;
    Vec3 last = set(d, occluder.corner[occluder.edges - 1]) - from;
    for (std::size_t edge = 0; edge < occluder.edges; ++edge) {
      const Vec3 next = set(d, occluder.corner[edge]) - from;
      const Vec six_volumes = dot(cross(next, last), along);
      least[edge] = hn::Min(least[edge], six_volumes);
      most[edge] = hn::Max(most[edge], six_volumes);
      last = next;
    }
  }
  const auto all_over = [d](Vec values, float margin_of) {
    return hn::AllTrue(d, hn::Gt(values, hn::Set(d, margin_of)));
  };
  const auto all_under = [d](Vec values, float margin_of) {
    return hn::AllTrue(d, hn::Lt(values, hn::Set(d, -margin_of)));
  };
  const bool from_above = all_over(lowest_from, margin.from_height);
  const bool from_below = all_under(highest_from, margin.from_height);
  const bool to_above = all_over(lowest_to, margin.to_height);
  const bool to_below = all_under(highest_to, margin.to_height);
  // Seen from above, a segment through the inside has all volumes positive; from below, negative.
  std::size_t positive = 0, negative = 0;  // edges
  for (std::size_t edge = 0; edge < occluder.edges; ++edge) {
    positive += all_over(least[edge], margin.hull_volume) ? 1u : 0u;
    negative += all_under(most[edge], margin.hull_volume) ? 1u : 0u;
  }
  if ((from_above && (to_above || negative > 0)) || (from_below && (to_below || positive > 0)) ||
      (positive > 0 && negative > 0))
    return Passage::open;
  const bool closed = (from_above && to_below && positive == occluder.edges) ||
                      (from_below && to_above && negative == occluder.edges);
  return closed ? Passage::closed : Passage::divided;
}

}  // namespace fluxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
