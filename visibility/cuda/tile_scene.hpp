#pragma once

#include <cstddef>
#include <cstdint>

#include "visibility/cuda/portable.hpp"

namespace fluxel::cuda {

/// Elements on a tile's side, and on the side of the squares of pairs that a warp works on.
inline constexpr std::uint32_t kTile = 64, kGroup = 16, kGroupsOfTile = kTile / kGroup;

/// An axis-parallel box [m].
struct Box {
  float low[3], high[3];
};

/// An element as the end of rays: 32 bytes.
struct End {
  Float3 centroid;
  std::uint32_t sides;  ///< bit 0: the front is an unknown, bit 1: the back
  Float3 normal;
  std::uint32_t unused;
};

/// Boxes around the ends of rays of sixteen elements, on their fronts and on their backs.
struct GroupHull {
  Box side[2];
};

/// A patch in the way, in single precision.
struct Occluder {
  Float3 corner[4];  ///< a triangle's last one stands twice
  Float3 normal;
  Float3 centre;
  float radius;  ///< [m], of the corners around the centre
  std::uint32_t corners;
};

/// The same as it was given.
struct ExactPatch {
  Double3 corner[4];
  Double3 normal;
  std::uint32_t corners;
  std::uint32_t number = 0;  ///< which of those that were given; set by SceneArrays
};

/// A node of a tree of boxes with up to eight children, 80 bytes (Ylitie, Karras & Laine, Efficient
/// incoherent ray traversal on GPUs through compressed wide BVHs, 2017). Child k has the box
/// origin + 2^exponent * [low, high] in each axis, widened outwards, and is
///   a node, where bit k of `inner` is set: number first_child + (how many of the bits below k are set);
///   else a leaf of patches[k] >> 5 patches, 0 where there is no child, from first_patch + (patches[k] & 31)
///   on.
struct WideNode {
  float origin[3];
  std::int8_t exponent[3];
  std::uint8_t inner;
  std::uint32_t first_child;
  std::uint32_t first_patch;
  std::uint8_t patches[8];
  std::uint8_t low[3][8];
  std::uint8_t high[3][8];
};
static_assert(sizeof(WideNode) == 80, "as its description says");

/// Of patches in a leaf, and of nodes on the path from the root to one.
inline constexpr std::uint32_t kMaxInLeaf = 4, kMaxLevels = 40;

/// What making a tile consists of, beside the facing of its pairs: a child's box against a shaft, a patch
/// against a shaft, a child's box against a ray, a patch against a ray in single precision, and in double.
enum class Work { box_of_shaft, patch_of_shaft, box_of_ray, patch_of_ray, exact_patch };

/// All that rays need, as plain arrays in the memory of the host or of a device. Elements and hulls are
/// padded to whole tiles with elements without sides; patches follow the leaves of the tree.
struct TileScene {
  const End* ends;
  const GroupHull* hulls;
  const Occluder* occluders;
  const ExactPatch* exact;
  const WideNode* nodes;  ///< the root first; none without patches
  std::uint32_t tiles;    ///< on the matrix's side
  std::uint32_t patches;
  float extent;  ///< [m], the largest coordinate
  float lift;    ///< [m], of ends off their elements' planes

  /// Called before each piece of work. Who counts it has the work done on a scene of a class derived from
  /// this.
  FLUXEL_PORTABLE void count(Work /*work*/) const {}
};

/// A tile of the matrix, column >= row.
struct TilePlace {
  std::uint32_t row, column;
};

/// What a tile came to. Read as 64 little-endian words of 64 bits, bit c of word r says whether the pair sees
/// each other; of a tile on the diagonal, columns behind the row only.
struct TileResult {
  std::uint16_t part[kTile][kGroupsOfTile];
  std::uint32_t facing;  ///< pairs with sides that face each other
  std::uint32_t tested;  ///< of these, those that something may stand between
};

}  // namespace fluxel::cuda
