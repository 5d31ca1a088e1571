#pragma once

// Portable: what a device compiles too (see visibility/cuda/portable.hpp).

#include <cstddef>

#include "octree/octree_view.hpp"

namespace fluxel {

/// So few references are one loop; more levels would take longer to go down.
inline constexpr std::uint32_t kFewReferences = 8;

/// A cube is not halved where its children would hold more than so many times its references (Frolov et al.
/// 2014).
inline constexpr double kMostGrowth = 2.5;

/// Of references that are looked at on one level: more are left as they are, so that numbers of 32 bits hold.
inline constexpr std::size_t kMostOpen = std::size_t{1} << 30;

/// A sphere that reaches into a cube, in the order of a sort: the cube's number among those of its level,
/// then the sphere's.
using OctreeReference = std::uint64_t;

FLUXEL_PORTABLE inline std::uint32_t cube_of(OctreeReference reference) {
  return static_cast<std::uint32_t>(reference >> 32);
}
FLUXEL_PORTABLE inline std::uint32_t sphere_of(OctreeReference reference) {
  return static_cast<std::uint32_t>(reference);
}

/// Of a byte, the bits that are set.
FLUXEL_PORTABLE inline std::uint32_t count_bits(std::uint32_t byte) {
  byte = byte - (byte >> 1 & 0x55u);
  byte = (byte & 0x33u) + (byte >> 2 & 0x33u);
  return (byte + (byte >> 4)) & 0xFu;
}

struct OctreeCube {
  OctreePlace place;
  std::uint32_t first, count;  ///< in the open references
};

/// Of one level, the arrays of the passes below, in the memory of what runs them. A pass is called with each
/// number of a reference or of a cube, in any order or at once; none reads what another call of it writes.
struct OctreeLevel {
  OctreeView frame;  ///< without nodes and references
  const Sphere* spheres;
  int level;  ///< below the root

  OctreeCube* cubes;
  OctreeReference* open;  ///< of the cubes, in their order
  std::size_t cube_count, open_count;

  std::uint8_t* met;      ///< of each reference: the children that it goes on to, a bit each
  std::uint64_t* growth;  ///< of each reference: bits of `met`, then their sum before it
  std::uint64_t grown;    ///< the sum of all

  std::uint8_t* divided;  ///< of each cube: whether it is
  std::uint32_t* rank;    ///< of each cube: that, then how many are before it
  std::uint32_t* kept;    ///< of each cube: references of a leaf, then those before it

  OctreeNode* nodes;                    ///< of the tree
  std::uint32_t* references;            ///< likewise
  std::uint32_t first_node, next_node;  ///< of the level, of the next one
  std::uint32_t first_kept;

  std::uint32_t* place;  ///< of each reference: bits of `met` where it goes on, then their sum before it
  OctreeReference* next;
  OctreeCube* children;
};

namespace octree_pass {

/// Of the only cube, still without references.
struct AddRoot {
  OctreeLevel at;
  FLUXEL_PORTABLE void operator()(std::size_t c) const { at.cubes[c] = {{0, 0, 0}, 0, 0}; }
};

/// Of each reference: the root's, which holds all spheres.
struct Open {
  OctreeLevel at;
  FLUXEL_PORTABLE void operator()(std::size_t k) const { at.open[k] = k; }
};

/// Of each reference: where those of a cube begin, and then how many they are.
struct BeginCubes {
  OctreeLevel at;
  FLUXEL_PORTABLE void operator()(std::size_t k) const {
    const std::uint32_t cube = cube_of(at.open[k]);
    if (k == 0 || cube_of(at.open[k - 1]) != cube) at.cubes[cube].first = static_cast<std::uint32_t>(k);
  }
};
struct EndCubes {
  OctreeLevel at;
  FLUXEL_PORTABLE void operator()(std::size_t k) const {
    OctreeCube& cube = at.cubes[cube_of(at.open[k])];
    if (k + 1 == at.open_count || cube_of(at.open[k + 1]) != cube_of(at.open[k]))
      cube.count = static_cast<std::uint32_t>(k) + 1 - cube.first;
  }
};

/// Of each reference: which children it goes on to.
struct Test {
  OctreeLevel at;
  FLUXEL_PORTABLE void operator()(std::size_t k) const {
    const OctreeCube& cube = at.cubes[cube_of(at.open[k])];
    std::uint32_t met = 0;
    if (at.level < kOctreeLevels && at.open_count <= kMostOpen && cube.count > kFewReferences)
      met = at.frame.children_met(cube.place, at.level, at.spheres[sphere_of(at.open[k])]);
    at.met[k] = static_cast<std::uint8_t>(met);
    at.growth[k] = count_bits(met);
  }
};

/// Of each cube: whether it is divided.
struct Divide {
  OctreeLevel at;
  FLUXEL_PORTABLE void operator()(std::size_t c) const {
    const OctreeCube& cube = at.cubes[c];
    const std::size_t end = std::size_t{cube.first} + cube.count;
    const std::uint64_t grown =
        cube.count == 0 ? 0 : (end < at.open_count ? at.growth[end] : at.grown) - at.growth[cube.first];
    const bool divided = grown > 0 && static_cast<double>(grown) <= kMostGrowth * cube.count;
    at.divided[c] = divided ? 1 : 0;
    at.rank[c] = divided ? 1 : 0;
    at.kept[c] = divided ? 0 : cube.count;
  }
};

/// Of each cube: its node.
struct MakeNode {
  OctreeLevel at;
  FLUXEL_PORTABLE void operator()(std::size_t c) const {
    at.nodes[at.first_node + c] = at.divided[c] != 0
                                      ? OctreeNode{at.next_node + 8 * at.rank[c], OctreeNode::kInner}
                                      : OctreeNode{at.first_kept + at.kept[c], at.cubes[c].count};
  }
};

/// Of each reference: those of leaves stay.
struct Keep {
  OctreeLevel at;
  FLUXEL_PORTABLE void operator()(std::size_t k) const {
    const std::uint32_t c = cube_of(at.open[k]);
    if (at.divided[c] != 0) return;
    at.references[at.first_kept + at.kept[c] + (k - at.cubes[c].first)] = sphere_of(at.open[k]);
  }
};

/// Of each reference: how many it becomes on the next level.
struct Place {
  OctreeLevel at;
  FLUXEL_PORTABLE void operator()(std::size_t k) const {
    at.place[k] = at.divided[cube_of(at.open[k])] != 0 ? count_bits(at.met[k]) : 0;
  }
};

/// Of each reference: these, in the order of the children that hold them only when sorted.
struct Append {
  OctreeLevel at;
  FLUXEL_PORTABLE void operator()(std::size_t k) const {
    const std::uint32_t cube = cube_of(at.open[k]);
    if (at.divided[cube] == 0) return;
    std::uint32_t place = at.place[k];
    for (std::uint32_t child = 0; child < 8; ++child)
      if ((at.met[k] >> child & 1u) != 0)
        at.next[place++] = (OctreeReference{8 * at.rank[cube] + child} << 32) | sphere_of(at.open[k]);
  }
};

/// Of each cube: its children, still without references.
struct AddChildren {
  OctreeLevel at;
  FLUXEL_PORTABLE void operator()(std::size_t c) const {
    if (at.divided[c] == 0) return;
    for (std::uint32_t child = 0; child < 8; ++child)
      at.children[8 * at.rank[c] + child] = {at.cubes[c].place.child(child), 0, 0};
  }
};

}  // namespace octree_pass

}  // namespace fluxel
