#include "visibility/occlusion.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/occlusion.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set

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

/// An occluder that may part the rays of a bundle.
struct Divider {
  const Occluder* occluder;
  Margins margin;
  PlaneSides rows, columns;
};

/// Normals of the planes through an edge of an occluder and a row's point, by edge, axis and row of a group.
/// They point inwards; of a row that may lie in the occluder's plane they are zero.
struct alignas(64) EdgePlanes {
  std::array<std::array<std::array<float, kGroup>, 3>, 4> normal;
};

/// The dividers of a bundle. Lists are of their indices.
struct Dividers {
  std::array<Divider, kMaxOccluders> divider;
  std::array<EdgePlanes, kMaxOccluders> planes;  // for the rows of the group at work
  std::size_t count = 0;
};

struct List {
  std::array<std::uint32_t, kMaxOccluders> index;
  std::size_t size = 0;

  [[nodiscard]] std::span<const std::uint32_t> all() const { return std::span(index).first(size); }
};

PlaneSides sides_of_plane(const Occluder& occluder, const TileVectors& points, float extent) {
  const Float d;
  const Vec3 normal = set(d, occluder.normal), base = set(d, occluder.corner[0]);
  const Vec ulps = hn::Set(d, plane_margin(1, 0)), rounding = hn::Set(d, plane_margin(0, extent));
  PlaneSides sides{};
  for (std::size_t k = 0; k < kTileSize; k += hn::Lanes(d)) {
    const Vec3 separation = load(d, points, k) - base;
    const Vec height = dot(normal, separation);
    const Vec margin = hn::MulAdd(ulps, hn::Sqrt(dot(separation, separation)), rounding);
    sides.above |= bits_of(d, hn::Gt(height, margin)) << k;
    sides.below |= bits_of(d, hn::Lt(height, hn::Neg(margin))) << k;
  }
  return sides;
}

void set_planes(const Divider& divider, const TileVectors& points, std::size_t first, EdgePlanes& planes) {
  const Float d;
  const Occluder& occluder = *divider.occluder;
  const std::uint64_t above = divider.rows.above >> first, below = divider.rows.below >> first;
  for (std::size_t k = 0; k < kGroup; k += hn::Lanes(d)) {
    const Vec3 from = load(d, points, first + k);
    const Vec sign = hn::IfThenElse(mask_of(d, above >> k), hn::Set(d, 1.0f),
                                    hn::IfThenElseZero(mask_of(d, below >> k), hn::Set(d, -1.0f)));
    Vec3 last = set(d, occluder.corner[occluder.edges - 1]) - from;
    for (std::size_t edge = 0; edge < occluder.edges; ++edge) {
      const Vec3 next = set(d, occluder.corner[edge]) - from;
      const Vec3 normal = cross(next, last);
      hn::Store(hn::Mul(sign, normal.x), d, planes.normal[edge][0].data() + k);
      hn::Store(hn::Mul(sign, normal.y), d, planes.normal[edge][1].data() + k);
      hn::Store(hn::Mul(sign, normal.z), d, planes.normal[edge][2].data() + k);
      last = next;
    }
  }
}

/// The rays `open` from a row to the vector of columns from `first` on, as bits from 0; leaves those that
/// are not certainly blocked and returns the unsure among them.
HWY_INLINE std::uint64_t occlude_vector(const Dividers& dividers, const List& near, std::size_t row,
                                        std::size_t row_in_group, const Vec3& along, std::size_t first,
                                        std::uint64_t& open) {
  const Float d;
  std::uint64_t unsure = 0;
  for (const std::uint32_t i : near.all()) {
    const Divider& divider = dividers.divider[i];
    Vec least = hn::Set(d, std::numeric_limits<float>::max());
    for (std::size_t edge = 0; edge < divider.occluder->edges; ++edge) {
      const auto& normal = dividers.planes[i].normal[edge];
      least = hn::Min(least, dot({hn::Set(d, normal[0][row_in_group]), hn::Set(d, normal[1][row_in_group]),
                                  hn::Set(d, normal[2][row_in_group])},
                                 along));
    }
    const Vec volume = hn::Set(d, divider.margin.ray_volume);
    const std::uint64_t inside = bits_of(d, hn::Gt(least, volume));
    const std::uint64_t outside = bits_of(d, hn::Lt(least, hn::Neg(volume)));
    const PlaneSides &from = divider.rows, &to = divider.columns;
    const auto has_row = [row](std::uint64_t word) { return (word >> row & 1u) != 0; };
    const std::uint64_t stays = has_row(from.above) ? to.above : has_row(from.below) ? to.below : 0;
    const std::uint64_t crosses = has_row(from.above) ? to.below : has_row(from.below) ? to.above : 0;
    const std::uint64_t met = open & ~(stays >> first) & ~outside;
    const std::uint64_t blocked = met & inside & (crosses >> first);
    unsure |= met & ~blocked;
    open &= ~blocked;
    if (open == 0) break;
  }
  return unsure & open;
}

void occlude_row(const Dividers& dividers, const List& near, const glm::vec3& from, std::size_t row,
                 std::size_t row_in_group, const TileVectors& to, std::size_t first_column,
                 std::uint64_t rays, Occlusion& result) {
  const Float d;
  const std::uint64_t lanes = low_bits(hn::Lanes(d));
  for (std::size_t c = first_column; c < std::min(first_column + kGroup, kTileSize); c += hn::Lanes(d)) {
    const std::uint64_t asked = rays >> c & lanes;
    if (asked == 0) continue;
    std::uint64_t open = asked;
    const Vec3 along = load(d, to, c) - set(d, from);
    result.unsure[row] |= occlude_vector(dividers, near, row, row_in_group, along, c, open) << c;
    result.blocked[row] |= (asked & ~open) << c;
  }
}

/// The occluders that divide the segments between two hulls; false where one closes them all.
bool find_dividers(const RayBundle& bundle, std::span<const Occluder> occluders, std::span<const PatchId> ids,
                   HullSegments& segments, Dividers& dividers) {
  set_segments(bundle.from.whole->corners(bundle.row_side), bundle.to.whole->corners(bundle.column_side),
               segments);
  for (const PatchId id : ids) {
    const Occluder& occluder = occluders[index(id)];
    const Margins margin = margins(occluder, segments, bundle.extent);
    const Passage through = passage(occluder, segments, margin);
    if (through == Passage::closed) return false;
    if (through == Passage::open) continue;
    Divider& divider = dividers.divider[dividers.count++];
    divider.occluder = &occluder;
    divider.margin = margin;
    divider.rows = sides_of_plane(occluder, bundle.rows.lifted[index(bundle.row_side)], bundle.extent);
    divider.columns =
        sides_of_plane(occluder, bundle.columns.lifted[index(bundle.column_side)], bundle.extent);
  }
  return true;
}

/// Those of `among` that divide the segments between two smaller hulls; false where one closes them all.
/// Nothing is to be asked again where the smaller hulls are the larger ones.
bool narrow(const Dividers& dividers, const List& among, std::span<const glm::vec3> from,
            std::span<const glm::vec3> to, bool smaller, HullSegments& segments, List& near) {
  if (!smaller) {
    near = among;
    return true;
  }
  set_segments(from, to, segments);
  near.size = 0;
  for (const std::uint32_t i : among.all()) {
    const Passage through = passage(*dividers.divider[i].occluder, segments, dividers.divider[i].margin);
    if (through == Passage::closed) return false;
    if (through == Passage::divided) near.index[near.size++] = i;
  }
  return true;
}

void occlude(const RayBundle& bundle, std::span<const Occluder> occluders, std::span<const PatchId> ids,
             const TileBits& rays, Occlusion& result) {
  HullSegments segments;
  Dividers dividers;
  if (!find_dividers(bundle, occluders, ids, segments, dividers))
    return add_rays(*bundle.from.whole, *bundle.to.whole, rays, result.blocked);
  if (dividers.count == 0) return;
  List of_bundle, of_rows, of_block;
  for (std::uint32_t i = 0; i < dividers.count; ++i) of_bundle.index[of_bundle.size++] = i;

  const TileVectors& from = bundle.rows.lifted[index(bundle.row_side)];
  const TileVectors& to = bundle.columns.lifted[index(bundle.column_side)];
  const auto whole = bundle.to.whole->corners(bundle.column_side);
  for (const Cluster& rows : bundle.from.groups) {
    if (!any_ray(rows, *bundle.to.whole, rays)) continue;
    const auto hull = rows.corners(bundle.row_side);
    if (!narrow(dividers, of_bundle, hull, whole, bundle.from.groups.size() > 1, segments, of_rows)) {
      add_rays(rows, *bundle.to.whole, rays, result.blocked);
      continue;
    }
    for (const std::uint32_t i : of_rows.all())
      set_planes(dividers.divider[i], from, rows.first, dividers.planes[i]);
    for (const Cluster& columns : bundle.to.groups) {
      if (of_rows.size == 0 || !any_ray(rows, columns, rays)) continue;
      if (!narrow(dividers, of_rows, hull, columns.corners(bundle.column_side), bundle.to.groups.size() > 1,
                  segments, of_block)) {
        add_rays(rows, columns, rays, result.blocked);
        continue;
      }
      if (of_block.size == 0) continue;
      for (std::size_t r = rows.first; r < rows.last; ++r)
        occlude_row(dividers, of_block, from.at(r), r, r - rows.first, to, columns.first,
                    rays[r] & columns.mask(), result);
    }
  }
}

}  // namespace fluxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace fluxel {

HWY_EXPORT(occlude);

void occlude(const RayBundle& bundle, std::span<const Occluder> occluders, std::span<const PatchId> ids,
             const TileBits& rays, Occlusion& result) {
  HWY_DYNAMIC_DISPATCH(occlude)(bundle, occluders, ids, rays, result);
}

}  // namespace fluxel

#endif  // HWY_ONCE
