#include "visibility/occlusion.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/occlusion.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set

#include <bit>
#include <boost/container/static_vector.hpp>
#include <limits>

#include "visibility/lanes-inl.hpp"
#include "visibility/passage-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fluxel::HWY_NAMESPACE {

/// Which points of a tile lie certainly above a plane, and which below.
struct PlaneSides {
  std::uint64_t above, below;
};

/// A body that may part the rays of a bundle, and what it is to those of the row at work.
struct Divider {
  const ConvexBody* body;
  Margins margin;
  std::array<PlaneSides, ConvexBody::kMaxFaces> rows, columns;  // by face: outside and inside
  FaceSides sides;                                              // that the row's point is on
  OutlineEdges outline;                                         // from there
  std::uint64_t behind;  // columns that it certainly hides where their rays pass inside all planes
  std::uint64_t beside;  // and those that it certainly does not hide

  Divider(const ConvexBody& of, const Margins& margins_) : body(&of), margin(margins_), outline(of, sides) {}
};

using Dividers = boost::container::static_vector<Divider, kMaxBodies>;

/// From a row's point to all columns.
struct alignas(64) RayVectors {
  std::array<float, kTileSize> x, y, z;
};

/// Of the points of a cluster.
PlaneSides sides_of_plane(const glm::vec3& face_normal, const glm::vec3& corner, const Cluster& cluster,
                          const TileVectors& points, float extent) {
  const Float d;
  const Vec3 normal = set(d, face_normal), base = set(d, corner);
  const Vec ulps = hn::Set(d, plane_margin(1, 0)), rounding = hn::Set(d, plane_margin(0, extent));
  PlaneSides sides{};
  for (std::size_t k = cluster.first; k < cluster.last; k += hn::Lanes(d)) {
    const Vec3 separation = load(d, points, k) - base;
    const Vec height = dot(normal, separation);
    const Vec margin = hn::MulAdd(ulps, hn::Sqrt(dot(separation, separation)), rounding);
    sides.above |= bits_of(d, hn::Gt(height, margin)) << k;
    sides.below |= bits_of(d, hn::Lt(height, hn::Neg(margin))) << k;
  }
  return sides;
}

void find_point_sides(const ConvexBody& body, const Cluster& cluster, const TileVectors& points, float extent,
                      std::array<PlaneSides, ConvexBody::kMaxFaces>& sides) {
  for (std::uint32_t plane = 0; plane < body.planes; ++plane)
    sides[plane] = sides_of_plane(body.normal[plane], body.base[plane], cluster, points, extent);
  if (body.is_flat()) sides[1] = {sides[0].below, sides[0].above};
}

/// Normals of the planes through a point and a body's edges, inwards where those are of its outline.
struct alignas(64) Outlined {
  std::array<std::array<float, ConvexBody::kMaxEdges>, 3> normal;  // by axis

  Outlined(const ConvexBody& body, const OutlineEdges& outline, const glm::vec3& point) {
    const Float d;
    const Vec3 apex = set(d, point);
    for (std::size_t k = 0; k < body.edges; k += hn::Lanes(d)) {
      const Vec3 from = load(d, body.from, k), to = load(d, body.to, k);
      const Vec3 inwards = cross(to - apex, from - apex);
      const auto turned = mask_of(d, outline.right >> k);
      const auto store = [&](Vec v, std::size_t axis) {
        hn::Store(hn::IfThenElse(turned, hn::Neg(v), v), d, &normal[axis][k]);
      };
      store(inwards.x, 0);
      store(inwards.y, 1);
      store(inwards.z, 2);
    }
  }
};

FaceSides sides_of_row(const Divider& divider, std::size_t row) {
  FaceSides sides;
  for (std::uint32_t face = 0; face < divider.body->faces; ++face) {
    sides.outside |= static_cast<std::uint32_t>(divider.rows[face].above >> row & 1u) << face;
    sides.inside |= static_cast<std::uint32_t>(divider.rows[face].below >> row & 1u) << face;
  }
  return sides;
}

/// What the body hides and what it does not of the columns, from a point on these sides of its faces.
void find_columns(Divider& divider) {
  const std::uint32_t all = divider.body->all_faces();
  std::uint64_t behind = ~std::uint64_t{0}, behind_all = ~std::uint64_t{0};
  divider.beside = 0;
  for (std::uint32_t face = 0; face < divider.body->faces; ++face) {
    const PlaneSides& columns = divider.columns[face];
    behind_all &= columns.below;
    if ((divider.sides.outside >> face & 1u) == 0) continue;
    divider.beside |= columns.above;
    behind &= columns.below;
  }
  if (divider.sides.inside == all) divider.beside = behind_all;  // both ends within
  const bool all_known = (divider.sides.outside | divider.sides.inside) == all;
  divider.behind = all_known && divider.sides.outside != 0 ? behind : 0;
}

void look_from(std::size_t row, Divider& divider) {
  const FaceSides sides = sides_of_row(divider, row);
  if (sides == divider.sides) return;  // nearly always
  divider.sides = sides;
  divider.outline = OutlineEdges(*divider.body, sides);
  find_columns(divider);
}

/// On which side of all planes of an outline rays certainly pass: bits of the columns.
struct RaySides {
  std::uint64_t inside = 0, outside = 0;
};

/// Of the columns that are asked for, and some beside them.
HWY_INLINE RaySides sides_of_rays(const Divider& divider, const glm::vec3& from, const RayVectors& along,
                                  std::uint64_t asked) {
  const Float d;
  const std::uint64_t lanes = low_bits(hn::Lanes(d));
  const Outlined seen(*divider.body, divider.outline, from);
  const Vec volume = hn::Set(d, divider.margin.ray_volume);
  RaySides sides;
  for (std::size_t c = 0; c < kTileSize; c += hn::Lanes(d)) {
    if ((asked >> c & lanes) == 0) continue;
    const Vec3 ray = load(d, along, c);
    Vec least = hn::Set(d, std::numeric_limits<float>::max());
    for (std::uint32_t left = divider.outline.all(); left != 0; left &= left - 1) {
      const auto edge = static_cast<std::size_t>(std::countr_zero(left));
      least = hn::Min(least, dot({hn::Set(d, seen.normal[0][edge]), hn::Set(d, seen.normal[1][edge]),
                                  hn::Set(d, seen.normal[2][edge])},
                                 ray));
    }
    sides.inside |= bits_of(d, hn::Gt(least, volume)) << c;
    sides.outside |= bits_of(d, hn::Lt(least, hn::Neg(volume))) << c;
  }
  return sides;
}

void occlude_row(Dividers& dividers, const glm::vec3& from, std::size_t row, const TileVectors& to,
                 std::uint64_t rays, Occlusion& result) {
  const Float d;
  RayVectors along;
  for (std::size_t c = 0; c < kTileSize; c += hn::Lanes(d)) store(d, load(d, to, c) - set(d, from), along, c);
  std::uint64_t open = rays, unsure = 0;
  for (Divider& divider : dividers) {
    look_from(row, divider);
    const std::uint64_t asked = open & ~divider.beside;
    if (asked == 0) continue;
    const RaySides sides = sides_of_rays(divider, from, along, asked);
    const std::uint64_t met = asked & ~sides.outside;
    const std::uint64_t blocked = met & sides.inside & divider.behind;
    unsure |= met & ~blocked;
    open &= ~blocked;
    if (open == 0) break;
  }
  result.blocked[row] |= rays & ~open;
  result.unsure[row] |= unsure & open;
}

/// The bodies that divide the segments between two hulls; false where one closes them all.
bool find_dividers(const RayBundle& bundle, std::span<const ConvexBody> bodies,
                   std::span<const std::uint32_t> numbers, Dividers& dividers) {
  HullSegments segments;
  set_segments(bundle.from.corners(bundle.row_side), bundle.to.corners(bundle.column_side), segments);
  for (const std::uint32_t number : numbers) {
    const ConvexBody& body = bodies[number];
    const Margins margin = margins(body, segments, bundle.extent);
    const Passage through = passage(body, segments, margin);
    if (through == Passage::closed) return false;
    if (through == Passage::open) continue;
    dividers.emplace_back(body, margin);
  }
  for (Divider& divider : dividers) {
    find_point_sides(*divider.body, bundle.from, bundle.rows.lifted[index(bundle.row_side)], bundle.extent,
                     divider.rows);
    find_point_sides(*divider.body, bundle.to, bundle.columns.lifted[index(bundle.column_side)],
                     bundle.extent, divider.columns);
    find_columns(divider);
  }
  return true;
}

void occlude(const RayBundle& bundle, std::span<const ConvexBody> bodies,
             std::span<const std::uint32_t> numbers, const TileBits& rays, Occlusion& result) {
  Dividers dividers;
  if (!find_dividers(bundle, bodies, numbers, dividers))
    return add_rays(bundle.from, bundle.to, rays, result.blocked);
  if (dividers.empty()) return;
  const TileVectors& from = bundle.rows.lifted[index(bundle.row_side)];
  const TileVectors& to = bundle.columns.lifted[index(bundle.column_side)];
  for (std::size_t r = bundle.from.first; r < bundle.from.last; ++r) {
    const std::uint64_t of_row = rays[r] & bundle.to.mask();
    if (of_row != 0) occlude_row(dividers, from.at(r), r, to, of_row, result);
  }
}

}  // namespace fluxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace fluxel {

HWY_EXPORT(occlude);

void occlude(const RayBundle& bundle, std::span<const ConvexBody> bodies,
             std::span<const std::uint32_t> numbers, const TileBits& rays, Occlusion& result) {
  HWY_DYNAMIC_DISPATCH(occlude)(bundle, bodies, numbers, rays, result);
}

}  // namespace fluxel

#endif  // HWY_ONCE
