#include "visibility/occlusion.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/occlusion.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set

#include <algorithm>
#include <bit>
#include <limits>

#include "visibility/lanes-inl.hpp"
#include "visibility/passage-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fluxel::HWY_NAMESPACE {

constexpr std::size_t kGroup = TilePoints::kGroupSize;

/// Which points of a tile lie certainly above a plane, and which below.
struct PlaneSides {
  std::uint64_t above, below;
};

/// A body that may part the rays of a bundle.
struct Divider {
  const ConvexBody* body;
  Margins margin;
  std::array<PlaneSides, ConvexBody::kMaxFaces> rows, columns;  // by face: outside and inside
};

/// What a body is to the rays from a row: the columns that it certainly hides where their rays pass inside
/// all planes, those that it certainly does not hide, and normals of the planes through the row's point and
/// the edges of its outline, inwards.
struct alignas(64) Outlined {
  std::array<std::array<float, ConvexBody::kMaxEdges>, 3> normal;  // by axis; of all edges
  std::uint64_t behind, beside;
  std::uint32_t edges;  // of the outline: bits
};

/// The dividers of a bundle.
struct Dividers {
  std::array<Divider, kMaxBodies> divider;
  std::array<std::array<Outlined, kGroup>, kMaxBodies> outlined;  // from the rows of the group at work
  std::size_t count = 0;
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

void set_normals(const ConvexBody& body, const OutlineEdges& outline, const glm::vec3& point,
                 Outlined& seen) {
  const Float d;
  const Vec3 apex = set(d, point);
  for (std::size_t k = 0; k < body.edges; k += hn::Lanes(d)) {
    const Vec3 from = load(d, body.from, k), to = load(d, body.to, k);
    const Vec3 normal = cross(to - apex, from - apex);
    const auto turned = mask_of(d, outline.right >> k);
    const auto store = [&](Vec v, std::size_t axis) {
      hn::Store(hn::IfThenElse(turned, hn::Neg(v), v), d, &seen.normal[axis][k]);
    };
    store(normal.x, 0);
    store(normal.y, 1);
    store(normal.z, 2);
  }
  seen.edges = outline.all();
}

FaceSides sides_of_row(const Divider& divider, std::size_t row) {
  FaceSides sides;
  for (std::uint32_t face = 0; face < divider.body->faces; ++face) {
    sides.outside |= static_cast<std::uint32_t>(divider.rows[face].above >> row & 1u) << face;
    sides.inside |= static_cast<std::uint32_t>(divider.rows[face].below >> row & 1u) << face;
  }
  return sides;
}

/// What the body hides and what it does not of the columns, from a point on these sides of its faces.
void find_columns(const Divider& divider, const FaceSides& of_row, Outlined& seen) {
  const std::uint32_t all = divider.body->all_faces();
  std::uint64_t behind = ~std::uint64_t{0}, behind_all = ~std::uint64_t{0};
  seen.beside = 0;
  for (std::uint32_t face = 0; face < divider.body->faces; ++face) {
    const PlaneSides& columns = divider.columns[face];
    behind_all &= columns.below;
    if ((of_row.outside >> face & 1u) == 0) continue;
    seen.beside |= columns.above;
    behind &= columns.below;
  }
  if (of_row.inside == all) seen.beside = behind_all;  // both ends within
  seen.behind = (of_row.outside | of_row.inside) == all && of_row.outside != 0 ? behind : 0;
}

void look_from(const Cluster& rows, const TileVectors& points, std::size_t i, Dividers& dividers) {
  const Divider& divider = dividers.divider[i];
  const Outlined* last = nullptr;
  FaceSides of_last;
  OutlineEdges outline(*divider.body, of_last);
  for (std::size_t r = rows.first; r < rows.last; ++r) {
    Outlined& seen = dividers.outlined[i][r - rows.first];
    const FaceSides of_row = sides_of_row(divider, r);
    if (last != nullptr && of_row == of_last) {  // nearly always
      seen.behind = last->behind, seen.beside = last->beside;
    } else {
      find_columns(divider, of_row, seen);
      outline = OutlineEdges(*divider.body, of_row);
    }
    set_normals(*divider.body, outline, points.at(r), seen);
    last = &seen, of_last = of_row;
  }
}

/// The rays `open` from a row to the vector of columns from `first` on, as bits from 0; leaves those that
/// are not certainly blocked and returns the unsure among them.
HWY_INLINE std::uint64_t occlude_vector(const Dividers& dividers, std::size_t row_in_group, const Vec3& along,
                                        std::size_t first, std::uint64_t& open) {
  const Float d;
  std::uint64_t unsure = 0;
  for (std::size_t i = 0; i < dividers.count; ++i) {
    const Outlined& seen = dividers.outlined[i][row_in_group];
    const std::uint64_t asked = open & ~(seen.beside >> first);
    if (asked == 0) continue;
    Vec least = hn::Set(d, std::numeric_limits<float>::max());
    for (std::uint32_t left = seen.edges; left != 0; left &= left - 1) {
      const auto edge = static_cast<std::size_t>(std::countr_zero(left));
      least = hn::Min(least, dot({hn::Set(d, seen.normal[0][edge]), hn::Set(d, seen.normal[1][edge]),
                                  hn::Set(d, seen.normal[2][edge])},
                                 along));
    }
    const Vec volume = hn::Set(d, dividers.divider[i].margin.ray_volume);
    const std::uint64_t inside = bits_of(d, hn::Gt(least, volume));
    const std::uint64_t outside = bits_of(d, hn::Lt(least, hn::Neg(volume)));
    const std::uint64_t met = asked & ~outside;
    const std::uint64_t blocked = met & inside & (seen.behind >> first);
    unsure |= met & ~blocked;
    open &= ~blocked;
    if (open == 0) break;
  }
  return unsure & open;
}

void occlude_row(const Dividers& dividers, const glm::vec3& from, std::size_t row, std::size_t row_in_group,
                 const TileVectors& to, std::uint64_t rays, Occlusion& result) {
  const Float d;
  const std::uint64_t lanes = low_bits(hn::Lanes(d));
  for (std::size_t c = 0; c < kTileSize; c += hn::Lanes(d)) {
    const std::uint64_t asked = rays >> c & lanes;
    if (asked == 0) continue;
    std::uint64_t open = asked;
    const Vec3 along = load(d, to, c) - set(d, from);
    result.unsure[row] |= occlude_vector(dividers, row_in_group, along, c, open) << c;
    result.blocked[row] |= (asked & ~open) << c;
  }
}

/// The bodies that divide the segments between two hulls; false where one closes them all.
bool find_dividers(const RayBundle& bundle, std::span<const ConvexBody> bodies,
                   std::span<const std::uint32_t> numbers, Dividers& dividers) {
  HullSegments segments;
  set_segments(bundle.from.whole->corners(bundle.row_side), bundle.to.whole->corners(bundle.column_side),
               segments);
  for (const std::uint32_t number : numbers) {
    const ConvexBody& body = bodies[number];
    const Margins margin = margins(body, segments, bundle.extent);
    const Passage through = passage(body, segments, margin);
    if (through == Passage::closed) return false;
    if (through == Passage::open) continue;
    Divider& divider = dividers.divider[dividers.count++];
    divider.body = &body;
    divider.margin = margin;
  }
  for (std::size_t i = 0; i < dividers.count; ++i) {
    Divider& divider = dividers.divider[i];
    find_point_sides(*divider.body, *bundle.from.whole, bundle.rows.lifted[index(bundle.row_side)],
                     bundle.extent, divider.rows);
    find_point_sides(*divider.body, *bundle.to.whole, bundle.columns.lifted[index(bundle.column_side)],
                     bundle.extent, divider.columns);
  }
  return true;
}

void occlude(const RayBundle& bundle, std::span<const ConvexBody> bodies,
             std::span<const std::uint32_t> numbers, const TileBits& rays, Occlusion& result) {
  Dividers dividers;
  if (!find_dividers(bundle, bodies, numbers, dividers))
    return add_rays(*bundle.from.whole, *bundle.to.whole, rays, result.blocked);
  if (dividers.count == 0) return;
  const TileVectors& from = bundle.rows.lifted[index(bundle.row_side)];
  const TileVectors& to = bundle.columns.lifted[index(bundle.column_side)];
  for (const Cluster& rows : bundle.from.groups) {
    if (!any_ray(rows, *bundle.to.whole, rays)) continue;
    for (std::size_t i = 0; i < dividers.count; ++i) look_from(rows, from, i, dividers);
    for (std::size_t r = rows.first; r < rows.last; ++r)
      occlude_row(dividers, from.at(r), r, r - rows.first, to, rays[r] & bundle.to.whole->mask(), result);
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
