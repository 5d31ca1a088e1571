#pragma once

#include "visibility/cuda/tree_walk.hpp"

namespace fluxel::cuda {

/// So many patches a group's list may have; with more, each ray walks down the tree.
inline constexpr std::uint32_t kMaxListed = 64;
inline constexpr std::uint32_t kMaxWaiting = 128;  // nodes

/// A group is 16 x 16 pairs, two rows of it at a time are one of a warp's steps.
inline constexpr std::uint32_t kSteps = kGroup * kGroup / kLanes;

/// What the lanes of a warp share.
struct GroupMemory {
  BoxShaft shaft;
  std::uint32_t waiting[kMaxWaiting];  // nodes to be looked at
  std::uint32_t children[kLanes];      // that are to wait
  std::uint32_t listed[kMaxListed];    // patches
  Margins margin[kMaxListed];
  std::uint32_t rays[kSteps];  // bit 16 r + c: of row r of the step's two and column c
};

/// A group of pairs: sixteen rows and sixteen columns, by the numbers of their first elements.
struct GroupPlace {
  std::uint32_t row, column;
};

FLUXEL_PORTABLE inline std::uint32_t row_of(const GroupPlace& place, std::uint32_t step, std::uint32_t lane) {
  return place.row + 2 * step + lane / kGroup;
}
FLUXEL_PORTABLE inline std::uint32_t column_of(const GroupPlace& place, std::uint32_t lane) {
  return place.column + lane % kGroup;
}

/// A side of the rows and one of the columns: 0 front, 1 back.
struct SidePair {
  std::uint32_t row, column;
};

/// Pairs of sides of a group.
struct PairCounts {
  std::uint32_t facing = 0;  ///< that face each other
  std::uint32_t tested = 0;  ///< of those, with something that may stand between
};

/// Whether the row's side and the column's are unknowns and face each other: each centroid lies more than
/// `least` [m] off the other's plane.
FLUXEL_PORTABLE inline bool face_each_other(const End& row, const End& column, const SidePair& side,
                                            float least) {
  if ((row.sides >> side.row & 1u) == 0 || (column.sides >> side.column & 1u) == 0) return false;
  const Float3 separation = column.centroid - row.centroid;
  const float height = fused_dot(row.normal, separation), depth = fused_dot(column.normal, separation);
  return (side.row == 0 ? height > least : height < -least) &&
         (side.column == 0 ? depth < -least : depth > least);
}

FLUXEL_PORTABLE inline Float3 lifted(const End& end, std::uint32_t side, float lift) {
  return end.centroid + (side == 0 ? lift : -lift) * end.normal;
}

FLUXEL_PORTABLE inline Float3 centre(const Box& box) {
  return 0.5f * Float3{box.low[0] + box.high[0], box.low[1] + box.high[1], box.low[2] + box.high[2]};
}

FLUXEL_PORTABLE inline float radius(const Box& box) {
  return 0.5f * length(Float3{box.high[0] - box.low[0], box.high[1] - box.low[1], box.high[2] - box.low[2]});
}

/// Whether both boxes lie on one side of the occluder's plane, by more than `margin` [m].
FLUXEL_PORTABLE inline bool beside(const Occluder& occluder, const Box& a, const Box& b, float margin) {
  const Float3& n = occluder.normal;
  const auto height = [&](const Box& box) { return dot(n, centre(box) - occluder.corner[0]); };
  const auto reach = [&](const Box& box) {
    return 0.5f * (std::fabs(n.x) * (box.high[0] - box.low[0]) + std::fabs(n.y) * (box.high[1] - box.low[1]) +
                   std::fabs(n.z) * (box.high[2] - box.low[2])) +
           margin;
  };
  const float height_a = height(a), height_b = height(b), reach_a = reach(a), reach_b = reach(b);
  return (height_a > reach_a && height_b > reach_b) || (height_a < -reach_a && height_b < -reach_b);
}

/// The group's hulls on the sides that are looked at.
struct Bundle {
  const Box* row_box;
  const Box* column_box;
};

FLUXEL_PORTABLE inline Margins bundle_margins(const Occluder& occluder, const Bundle& bundle, float extent) {
  const Float3 from = centre(*bundle.row_box), to = centre(*bundle.column_box);
  const float from_radius = radius(*bundle.row_box), to_radius = radius(*bundle.column_box);
  return margins(occluder.radius + from_radius + length(from - occluder.centre),
                 occluder.radius + to_radius + length(to - occluder.centre),
                 from_radius + to_radius + length(to - from), extent);
}

/// Lists the patches that may stand between the hulls; returns their number, or
/// kMaxListed + 1 where there are more or the tree is too wide. All lanes look at the children of four nodes
/// at a time.
template <class Scene>
FLUXEL_PORTABLE std::uint32_t list_occluders(const Warp& warp, const Scene& scene, const Bundle& bundle,
                                             GroupMemory& memory) {
  warp.each([&](std::uint32_t lane) {
    if (lane < kShaftPlanes)
      memory.shaft.plane[lane] = shaft_plane(*bundle.row_box, *bundle.column_box, lane, scene.extent);
    if (lane == kShaftPlanes)
      memory.shaft.bounds = common_bounds(*bundle.row_box, *bundle.column_box, scene.extent);
    if (lane == 0) memory.waiting[0] = 0;
  });
  std::uint32_t waiting = scene.patches > 0 ? 1 : 0, listed = 0;
  while (waiting > 0) {
    const std::uint32_t taken = lesser(waiting, kLanes / 8);
    const std::uint32_t base = waiting - taken;
    waiting = base;
    const auto node_of = [&](std::uint32_t lane) -> const WideNode& {
      return scene.nodes[memory.waiting[base + lane / 8]];
    };
    const std::uint32_t met = warp.ballot([&](std::uint32_t lane) {
      if (lane / 8 >= taken) return false;
      const WideNode& node = node_of(lane);
      const std::uint32_t child = lane % 8;
      if (!is_node(node, child) && node.patches[child] >> 5 == 0) return false;
      scene.count(Work::box_of_shaft);
      return may_meet(memory.shaft, child_box(node, child));
    });
    if (met == 0) continue;
    for (std::uint32_t k = 0; k < kMaxInLeaf; ++k) {
      const auto patch_of = [&](std::uint32_t lane) {
        const WideNode& node = node_of(lane);
        return node.first_patch + (node.patches[lane % 8] & 31u) + k;
      };
      const std::uint32_t found = warp.ballot([&](std::uint32_t lane) {
        if ((met >> lane & 1u) == 0 || is_node(node_of(lane), lane % 8) ||
            k >= static_cast<std::uint32_t>(node_of(lane).patches[lane % 8] >> 5))
          return false;
        const std::uint32_t patch = patch_of(lane);
        const Occluder& occluder = scene.occluders[patch];
        scene.count(Work::patch_of_shaft);
        return may_meet(memory.shaft, occluder) &&
               !beside(occluder, *bundle.row_box, *bundle.column_box,
                       bundle_margins(occluder, bundle, scene.extent).height);
      });
      if (listed + count_bits(found) > kMaxListed) return kMaxListed + 1;
      warp.each([&](std::uint32_t lane) {
        if ((found >> lane & 1u) == 0) return;
        const std::uint32_t place = listed + count_bits(found & ((1u << lane) - 1));
        memory.listed[place] = patch_of(lane);
        memory.margin[place] = bundle_margins(scene.occluders[patch_of(lane)], bundle, scene.extent);
      });
      listed += count_bits(found);
    }
    const std::uint32_t inner = warp.ballot(
        [&](std::uint32_t lane) { return (met >> lane & 1u) != 0 && is_node(node_of(lane), lane % 8); });
    if (waiting + count_bits(inner) > kMaxWaiting) return kMaxListed + 1;
    warp.each([&](std::uint32_t lane) {
      if ((inner >> lane & 1u) != 0) memory.children[lane] = child_node(node_of(lane), lane % 8);
    });
    warp.each([&](std::uint32_t lane) {
      if ((inner >> lane & 1u) != 0)
        memory.waiting[waiting + count_bits(inner & ((1u << lane) - 1))] = memory.children[lane];
    });
    waiting += count_bits(inner);
  }
  return listed;
}

/// Whether something stands between the row and the column of a pair.
template <class Scene>
FLUXEL_PORTABLE bool is_hidden(const Scene& scene, const GroupMemory& memory, std::uint32_t listed,
                               const End& row, const End& column, const SidePair& side) {
  const Float3 from = lifted(row, side.row, scene.lift);
  const Float3 along = lifted(column, side.column, scene.lift) - from;
  if (listed > kMaxListed) return is_occluded(scene, from, along);
  for (std::uint32_t k = 0; k < listed; ++k)
    if (meets(scene, memory.listed[k], from, along, memory.margin[k])) return true;
  return false;
}

/// Adds what the sides see of each other to the group's part of a tile.
template <class Scene>
FLUXEL_PORTABLE void trace_sides(const Warp& warp, const Scene& scene, const GroupPlace& place,
                                 const SidePair& side, GroupMemory& memory, TileResult& result,
                                 PairCounts& counts) {
  std::uint32_t rays = 0;
  for (std::uint32_t step = 0; step < kSteps; ++step) {
    const std::uint32_t word = warp.ballot([&](std::uint32_t lane) {
      const std::uint32_t r = row_of(place, step, lane), c = column_of(place, lane);
      return c > r && face_each_other(scene.ends[r], scene.ends[c], side, 2 * scene.lift);
    });
    warp.each([&](std::uint32_t lane) {
      if (lane == 0) memory.rays[step] = word;
    });
    rays += count_bits(word);
  }
  if (rays == 0) return;
  counts.facing += rays;
  const GroupHull& rows = scene.hulls[place.row / kGroup];
  const GroupHull& columns = scene.hulls[place.column / kGroup];
  const std::uint32_t listed =
      list_occluders(warp, scene, {&rows.side[side.row], &columns.side[side.column]}, memory);
  if (listed > 0) counts.tested += rays;
  for (std::uint32_t step = 0; step < kSteps; ++step) {
    const std::uint32_t visible = warp.ballot([&](std::uint32_t lane) {
      return (memory.rays[step] >> lane & 1u) != 0 &&
             !is_hidden(scene, memory, listed, scene.ends[row_of(place, step, lane)],
                        scene.ends[column_of(place, lane)], side);
    });
    warp.each([&](std::uint32_t lane) {
      if (lane % kGroup == 0)
        result.part[row_of(place, step, lane) % kTile][place.column / kGroup % kGroupsOfTile] |=
            static_cast<std::uint16_t>(visible >> lane);
    });
  }
}

/// Group `group` of a tile, in rows of four: by all lanes of a warp. Tiles of the result must be cleared
/// before; groups of one tile write to different places, and each adds its own pairs to `counts`.
template <class Scene>
FLUXEL_PORTABLE void trace_group(const Warp& warp, const Scene& scene, const TilePlace& tile,
                                 std::uint32_t group, GroupMemory& memory, TileResult& result,
                                 PairCounts& counts) {
  const std::uint32_t row_group = group / kGroupsOfTile, column_group = group % kGroupsOfTile;
  const GroupPlace place{tile.row * kTile + row_group * kGroup, tile.column * kTile + column_group * kGroup};
  for (std::uint32_t row_side = 0; row_side < 2; ++row_side)
    for (std::uint32_t column_side = 0; column_side < 2; ++column_side)
      trace_sides(warp, scene, place, {row_side, column_side}, memory, result, counts);
}

}  // namespace fluxel::cuda
