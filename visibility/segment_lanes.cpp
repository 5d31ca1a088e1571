#include "visibility/segment_lanes.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/segment_lanes.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

#include <bit>
#include <cstring>

#include "visibility/segment_test.hpp"

HWY_BEFORE_NAMESPACE();
namespace fluxel::HWY_NAMESPACE {

namespace exact {

namespace hn = hwy::HWY_NAMESPACE;

using Double = hn::CappedTag<double, 8>;
using Vec = hn::Vec<Double>;
using Mask = hn::Mask<Double>;

struct Vec3 {
  Vec x, y, z;
};

HWY_INLINE Vec3 set(Double d, const glm::dvec3& v) {
  return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
}
HWY_INLINE Vec load(Double d, const float* from) {
  return hn::PromoteTo(d, hn::LoadU(hn::Rebind<float, Double>(), from));
}
HWY_INLINE Vec3 operator+(const Vec3& a, const Vec3& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Vec3 operator-(const Vec3& a, const Vec3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

// In the order of glm's, each product and sum rounded for itself.
HWY_INLINE Vec dot(const Vec3& a, const Vec3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Vec3 cross(const Vec3& a, const Vec3& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(b.y, a.z)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(b.z, a.x)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(b.x, a.y))};
}

HWY_INLINE std::uint32_t bits_of(Double d, Mask mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  return bytes[0];
}

/// As cuda::Place, in the plane across each segment's longest axis.
struct Places {
  Vec u, v;
};

struct Axes {
  Mask x, z;  // else y

  explicit Axes(const Vec3& along) {
    const Vec a = hn::Abs(along.x), b = hn::Abs(along.y), c = hn::Abs(along.z);
    z = hn::And(hn::Ge(c, a), hn::Ge(c, b));
    x = hn::AndNot(z, hn::Ge(a, b));
  }
};

HWY_INLINE Places places_of(Double d, const glm::dvec3& corner, const Vec3& from, const Vec3& along,
                            const Axes& axes) {
  const Vec3 moment = cross(set(d, corner) - from, along);
  return {hn::IfThenElse(axes.z, moment.x, hn::IfThenElse(axes.x, moment.y, moment.z)),
          hn::IfThenElse(axes.z, moment.y, hn::IfThenElse(axes.x, moment.z, moment.x))};
}

struct Met {
  std::uint32_t certainly, perhaps;
};

/// Of the vector of segments from `first` on, as bits from 0; where two products of a turn are equal, what
/// rounding took from them would have to be compared: perhaps.
HWY_INLINE Met meet_vector(Double d, const Patch& patch, const SegmentLanes& segments, std::size_t first) {
  const Vec3 from{load(d, segments.origin_x + first), load(d, segments.origin_y + first),
                  load(d, segments.origin_z + first)};
  const Vec3 direction{load(d, segments.direction_x + first), load(d, segments.direction_y + first),
                       load(d, segments.direction_z + first)};
  const Vec3 to = from + direction;
  const Vec3 along = to - from;
  const Vec3 normal = set(d, patch.normal), base = set(d, patch.outline.corner[0]);
  const auto is_above = [&](const Vec3& point) {
    return bits_of(d, hn::Gt(dot(normal, point - base), hn::Zero(d)));
  };
  const std::uint32_t crosses = is_above(from) ^ is_above(to);
  if (crosses == 0) return {0, 0};
  const Axes axes(along);
  std::uint32_t left_turn = 0, right_turn = 0, unknown = 0;
  const std::uint32_t corners = patch.outline.corners;
  Places last = places_of(d, patch.outline.corner[corners - 1], from, along, axes);
  for (std::uint32_t c = 0; c < corners; ++c) {
    const Places next = places_of(d, patch.outline.corner[c], from, along, axes);
    const Vec left = hn::Mul(last.u, next.v), right = hn::Mul(last.v, next.u);
    left_turn |= bits_of(d, hn::Gt(left, right));
    right_turn |= bits_of(d, hn::Lt(left, right));
    unknown |= bits_of(d, hn::Eq(left, right));
    last = next;
  }
  const std::uint32_t one_side = crosses & ~(left_turn & right_turn);
  return {one_side & ~unknown, one_side & unknown};
}

}  // namespace exact

namespace rounded {

namespace hn = hwy::HWY_NAMESPACE;

using Float = hn::CappedTag<float, 16>;
using Vec = hn::Vec<Float>;

/// Of the vector of segments from `first` on, as bits from 0.
HWY_INLINE std::uint64_t surely_meet(Float d, const TriangleCore& triangle, const SegmentLanes& segments,
                                     const Crossings& crossings, std::size_t first) {
  const auto load = [&](const float* from) { return hn::LoadU(d, from + first); };
  const auto dot = [&](const glm::vec3& a, Vec x, Vec y, Vec z) {
    return hn::MulAdd(hn::Set(d, a.x), x, hn::MulAdd(hn::Set(d, a.y), y, hn::Mul(hn::Set(d, a.z), z)));
  };
  const Vec u = load(crossings.u), v = load(crossings.v);
  const Vec share = hn::Min(hn::Min(u, v), hn::Sub(hn::Sub(hn::Set(d, 1), u), v));
  const Vec dx = load(segments.direction_x), dy = load(segments.direction_y), dz = load(segments.direction_z);
  const Vec ox = load(segments.origin_x), oy = load(segments.origin_y), oz = load(segments.origin_z);
  const Vec from = dot(triangle.normal, hn::Sub(ox, hn::Set(d, triangle.base.x)),
                       hn::Sub(oy, hn::Set(d, triangle.base.y)), hn::Sub(oz, hn::Set(d, triangle.base.z)));
  const Vec along = dot(triangle.normal, dx, dy, dz);
  const Vec to = hn::Add(from, along);
  const Vec squared_length = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
  const auto largest = [](Vec x, Vec y, Vec z) {
    return hn::Max(hn::Max(hn::Abs(x), hn::Abs(y)), hn::Abs(z));
  };
  const auto within = hn::And(hn::Le(largest(ox, oy, oz), hn::Set(d, triangle.reach)),
                              hn::Le(largest(dx, dy, dz), hn::Set(d, 2 * triangle.reach)));
  const auto inside = hn::Ge(share, hn::Set(d, triangle.least_share));
  const auto crosses =
      hn::And(hn::Lt(hn::Mul(from, to), hn::Zero(d)),
              hn::Ge(hn::Min(hn::Abs(from), hn::Abs(to)), hn::Set(d, triangle.least_height)));
  const float least_sine = TriangleCore::kLeastSine;
  const auto steep =
      hn::Ge(hn::Mul(along, along), hn::Mul(hn::Set(d, least_sine * least_sine), squared_length));
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, hn::And(hn::And(within, inside), hn::And(crosses, steep)), bytes);
  std::uint64_t bits = 0;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits;
}

}  // namespace rounded

std::uint32_t segments_surely_meet(const TriangleCore& triangle, const SegmentLanes& segments,
                                   const Crossings& crossings, std::uint32_t asked) {
  const rounded::Float d;
  const std::size_t lanes = rounded::hn::Lanes(d);
  if (segments.count % lanes != 0) return 0;
  std::uint64_t met = 0;
  for (std::size_t first = 0; first < segments.count; first += lanes)
    met |= rounded::surely_meet(d, triangle, segments, crossings, first) << first;
  return static_cast<std::uint32_t>(met) & asked;
}

std::uint32_t segments_meet(const Patch& patch, const SegmentLanes& segments, std::uint32_t asked) {
  const exact::Double d;
  const std::size_t lanes = exact::hn::Lanes(d);
  std::uint32_t met = 0, perhaps = 0;
  if (segments.count % lanes == 0) {
    for (std::size_t first = 0; first < segments.count; first += lanes) {
      if ((asked >> first & ((1u << lanes) - 1)) == 0) continue;
      const exact::Met of_vector = exact::meet_vector(d, patch, segments, first);
      met |= of_vector.certainly << first;
      perhaps |= of_vector.perhaps << first;
    }
  } else {
    perhaps = asked;
  }
  for (std::uint32_t left = perhaps & asked; left != 0; left &= left - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(left));
    const glm::dvec3 from(segments.origin_x[k], segments.origin_y[k], segments.origin_z[k]);
    const glm::dvec3 along(segments.direction_x[k], segments.direction_y[k], segments.direction_z[k]);
    if (segment_meets(patch, from, from + along)) met |= 1u << k;
  }
  return met & asked;
}

}  // namespace fluxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace fluxel {

HWY_EXPORT(segments_meet);
HWY_EXPORT(segments_surely_meet);

std::uint32_t segments_meet(const Patch& patch, const SegmentLanes& segments, std::uint32_t asked) {
  return HWY_DYNAMIC_DISPATCH(segments_meet)(patch, segments, asked);
}

std::uint32_t segments_surely_meet(const TriangleCore& triangle, const SegmentLanes& segments,
                                   const Crossings& crossings, std::uint32_t asked) {
  return HWY_DYNAMIC_DISPATCH(segments_surely_meet)(triangle, segments, crossings, asked);
}

}  // namespace fluxel

#endif  // HWY_ONCE
