#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fluxel {

/// A binary tree of axis-parallel boxes, of numbers alone: the device's trees are made of it too, where there
/// are no libraries.
struct BoxTree {
  using Point = std::array<double, 3>;

  struct Box {
    Point low, high;  ///< [m]
  };

  /// A leaf has the items order[first] to order[first + count - 1]; the children of another node, whose count
  /// is 0, are the nodes `first` and `first` + 1.
  struct Node {
    Box box;
    std::uint32_t first = 0, count = 0;
  };

  static constexpr std::size_t kLeafSize = 4;
  // Below this depth nodes are halved, so that no path is longer than 48 + 32 nodes.
  static constexpr int kMaxHeuristicDepth = 48;
  static constexpr std::size_t kMaxPath = 96;

  std::vector<Node> nodes;           ///< the root first; none without items
  std::vector<std::uint32_t> order;  ///< the items

  /// Splits by the surface area heuristic over bins of the centres (Wald, On fast construction of SAH-based
  /// bounding volume hierarchies, 2007). Depends on the boxes alone.
  explicit BoxTree(const std::vector<Box>& boxes);
};

}  // namespace fluxel
