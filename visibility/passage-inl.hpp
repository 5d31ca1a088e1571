// Whether a body lets the segments between two hulls pass: all, none or some. For the instruction set
// that is being compiled, as lanes-inl.hpp.
#if defined(FLUXEL_VISIBILITY_PASSAGE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef FLUXEL_VISIBILITY_PASSAGE_INL_HPP
#undef FLUXEL_VISIBILITY_PASSAGE_INL_HPP
#else
#define FLUXEL_VISIBILITY_PASSAGE_INL_HPP
#endif

#include <algorithm>
#include <bit>
#include <glm/geometric.hpp>
#include <limits>
#include <span>

#include "visibility/convex_body.hpp"
#include "visibility/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fluxel::HWY_NAMESPACE {

/// All segments from a corner of one hull to a corner of another, as lines in the coordinates of Pluecker,
/// from the first hull's centre. A volume over an edge of a body is linear in either end of the segment, so
/// that its signs at these tell that of all segments between.
struct HullSegments {
  static constexpr std::size_t kMax = 64, kEnds = 8;
  struct Vectors {
    std::array<float, kMax> x, y, z;
  };
  alignas(64) Vectors along;
  alignas(64) Vectors moment;
  std::size_t count = 0;  // 16, 32 or 64
  // The corners themselves, of the first hull and then of the second; a hull's last one fills its places.
  alignas(64) std::array<float, 2 * kEnds> end_x, end_y, end_z;
  glm::vec3 from_centre{0}, to_centre{0};
  float from_radius = 0, to_radius = 0, longest = 0;  // [m]
};

inline void set_segments(std::span<const glm::vec3> from, std::span<const glm::vec3> to,
                         HullSegments& segments) {
  for (std::size_t i = 0; i < 2 * HullSegments::kEnds; ++i) {
    const std::span<const glm::vec3> hull = i < HullSegments::kEnds ? from : to;
    const glm::vec3& corner = hull[std::min(i % HullSegments::kEnds, hull.size() - 1)];
    segments.end_x[i] = corner.x, segments.end_y[i] = corner.y, segments.end_z[i] = corner.z;
  }
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
  std::size_t k = 0;
  for (const glm::vec3& from_corner : from) {
    for (const glm::vec3& to_corner : to) {
      const glm::vec3 a = from_corner - segments.from_centre, b = to_corner - segments.from_centre;
      const glm::vec3 along = b - a, moment = glm::cross(a, b);
      segments.along.x[k] = along.x, segments.along.y[k] = along.y, segments.along.z[k] = along.z;
      segments.moment.x[k] = moment.x, segments.moment.y[k] = moment.y, segments.moment.z[k] = moment.z;
      ++k;
    }
  }
  segments.count = k;
}

/// By how much an inequality in single precision has to hold to be certain, with u the rounding error of one
/// operation, E the scene's extent and R the distance of a body's corners from a ray's origin: a volume
/// over an edge and a ray of length q is known to (14 R + 4 E) u R q; from moments around the centre of
/// the hull that it starts from, to 42 u R^2 q, and to what the slack of
/// the hulls covers for rounded corners.
struct Margins {
  static constexpr float kUlp = 0x1p-24f;

  float from_height, to_height;  // [m], of the hulls over the planes of faces
  float hull_volume;             // [m3], six times that over an edge and a hull's segment
  float ray_volume;              // [m3], six times that over an edge and a ray
};

/// Rounding of a point's height over a plane, from the plane's corner this far away [m].
inline float plane_margin(float distance, float extent) { return 6 * Margins::kUlp * (distance + extent); }

inline Margins margins(const ConvexBody& body, const HullSegments& segments, float extent) {
  constexpr float kUlp = Margins::kUlp;
  const float from = body.radius + segments.from_radius + glm::length(segments.from_centre - body.centre);
  const float to = body.radius + segments.to_radius + glm::length(segments.to_centre - body.centre);
  Margins margin{};
  // The hulls stand for points that were rounded.
  const float slack = 16 * kUlp * extent;
  margin.from_height = plane_margin(from, extent) + slack;
  margin.to_height = plane_margin(to, extent) + slack;
  margin.ray_volume = kUlp * (16 * from + 4 * extent) * from * segments.longest;
  const float size = std::max(from, segments.longest);
  margin.hull_volume = kUlp * 48 * from * from * segments.longest + 6 * slack * size * size;
  return margin;
}

enum class Passage { open, closed, divided };

/// On which sides of a body's faces the ends of segments certainly lie: a bit a face.
struct FaceSides {
  std::uint32_t outside = 0, inside = 0;

  bool operator==(const FaceSides&) const = default;
};

/// Edges of a body's outline as seen from a point, or from all of a hull, on these sides of the faces: bits.
/// Seen from outside, the face to the left of those of `left` is turned to the point and the one to the right
/// turned away; of those of `right` it is the other way round. Edges between faces whose sides are not known
/// are in neither.
struct OutlineEdges {
  std::uint32_t left = 0, right = 0;

  OutlineEdges(const ConvexBody& body, const FaceSides& sides) {
    std::uint32_t left_of_near = 0, right_of_near = 0, left_of_far = 0, right_of_far = 0;
    for (std::uint32_t near = sides.outside; near != 0; near &= near - 1) {
      const auto face = static_cast<std::size_t>(std::countr_zero(near));
      left_of_near |= body.left[face], right_of_near |= body.right[face];
    }
    for (std::uint32_t far = sides.inside; far != 0; far &= far - 1) {
      const auto face = static_cast<std::size_t>(std::countr_zero(far));
      left_of_far |= body.left[face], right_of_far |= body.right[face];
    }
    left = left_of_near & right_of_far;
    right = right_of_near & left_of_far;
  }

  [[nodiscard]] std::uint32_t all() const { return left | right; }
};

/// The body's edges as lines, from their second ends to the first, from the same point as the segments.
struct EdgeLines {
  struct Vectors {
    std::array<float, ConvexBody::kMaxEdges> x, y, z;
  };
  alignas(64) Vectors along;
  alignas(64) Vectors moment;

  EdgeLines(const ConvexBody& body, const glm::vec3& origin) {
    const Float d;
    const Vec3 centre = set(d, origin);
    for (std::size_t k = 0; k < body.edges; k += hn::Lanes(d)) {
      const Vec3 from = load(d, body.from, k) - centre, to = load(d, body.to, k) - centre;
      store(d, from - to, along, k);
      store(d, cross(to, from), moment, k);
    }
  }
};

/// Of both hulls.
inline void find_sides(const ConvexBody& body, const HullSegments& segments, const Margins& margin,
                       FaceSides& of_from, FaceSides& of_to) {
  const Float d;
  constexpr std::uint64_t kFrom = 0xFF, kTo = 0xFF00;
  static_assert(HullSegments::kEnds == 8);
  for (std::uint32_t plane = 0; plane < body.planes; ++plane) {
    const Vec3 normal = set(d, body.normal[plane]), base = set(d, body.base[plane]);
    std::uint64_t above = 0, below = 0;
    for (std::size_t k = 0; k < 2 * HullSegments::kEnds; k += hn::Lanes(d)) {
      const Vec3 end{hn::Load(d, &segments.end_x[k]), hn::Load(d, &segments.end_y[k]),
                     hn::Load(d, &segments.end_z[k])};
      const Vec height = dot(normal, end - base);
      const auto is_from = hn::Lt(hn::Iota(d, static_cast<float>(k)), hn::Set(d, HullSegments::kEnds));
      const Vec least = hn::IfThenElse(is_from, hn::Set(d, margin.from_height), hn::Set(d, margin.to_height));
      above |= bits_of(d, hn::Gt(height, least)) << k;
      below |= bits_of(d, hn::Lt(height, hn::Neg(least))) << k;
    }
    const auto add = [&](FaceSides& sides, std::uint64_t ends) {
      if ((above & ends) == ends) sides.outside |= 1u << plane;
      if ((below & ends) == ends) sides.inside |= 1u << plane;
    };
    add(of_from, kFrom);
    add(of_to, kTo);
  }
  if (body.is_flat()) {
    for (FaceSides* sides : {&of_from, &of_to}) {
      const FaceSides of_first = *sides;
      sides->outside |= of_first.inside << 1;
      sides->inside |= of_first.outside << 1;
    }
  }
}

/// Whether the body meets none of the segments between two hulls, cuts all, or neither is certain.
inline Passage passage(const ConvexBody& body, const HullSegments& segments, const Margins& margin) {
  const Float d;
  FaceSides of_from, of_to;
  find_sides(body, segments, margin, of_from, of_to);
  const std::uint32_t all = body.all_faces();
  // Before a face, or nowhere outside.
  if ((of_from.outside & of_to.outside) != 0 || (of_from.inside & of_to.inside) == all) return Passage::open;
  const auto may_close = [all](const FaceSides& seen, const FaceSides& other) {
    return (seen.outside | seen.inside) == all && seen.outside != 0 && (seen.outside & ~other.inside) == 0;
  };
  bool closed_from = may_close(of_from, of_to), closed_to = may_close(of_to, of_from);

  // Seen from a face's outer side, a segment through the inside has all volumes over its edges positive; so
  // it has over the outline, where the near face is to the left. Seen from the other end signs are reversed.
  const OutlineEdges from_outline(body, of_from), to_outline(body, of_to);
  const std::uint32_t inner_positive = from_outline.left | to_outline.right;
  const std::uint32_t inner_negative = from_outline.right | to_outline.left;
  const EdgeLines lines(body, segments.from_centre);
  bool any_positive = false, any_negative = false;
  std::uint32_t edges = body.is_flat() ? (1u << body.edges) - 1 : inner_positive | inner_negative;
  for (; edges != 0; edges &= edges - 1) {
    const auto edge = static_cast<std::size_t>(std::countr_zero(edges));
    const Vec3 along = set(d, {lines.along.x[edge], lines.along.y[edge], lines.along.z[edge]});
    const Vec3 moment = set(d, {lines.moment.x[edge], lines.moment.y[edge], lines.moment.z[edge]});
    Vec least = hn::Set(d, std::numeric_limits<float>::max()), most = hn::Neg(least);
    for (std::size_t k = 0; k < segments.count; k += hn::Lanes(d)) {
      const Vec six_volumes =
          hn::Add(dot(along, load(d, segments.moment, k)), dot(moment, load(d, segments.along, k)));
      least = hn::Min(least, six_volumes);
      most = hn::Max(most, six_volumes);
    }
    const Vec volume = hn::Set(d, margin.hull_volume);
    const bool positive = hn::AllTrue(d, hn::Gt(least, volume));
    const bool negative = hn::AllTrue(d, hn::Lt(most, hn::Neg(volume)));
    const std::uint32_t bit = 1u << edge;
    if ((negative && (inner_positive & bit) != 0) || (positive && (inner_negative & bit) != 0))
      return Passage::open;
    any_positive = any_positive || positive;
    any_negative = any_negative || negative;
    // A polygon's line passes its edges on one side, whatever the side of its plane.
    if (body.is_flat() && any_positive && any_negative) return Passage::open;
    if ((from_outline.all() & bit) != 0 && !positive && !negative) closed_from = false;
    if ((to_outline.all() & bit) != 0 && !positive && !negative) closed_to = false;
  }
  return closed_from || closed_to ? Passage::closed : Passage::divided;
}

}  // namespace fluxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
