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

/// Walks a tree whose nodes are linked as BoxTree's, in whatever precision their boxes are: calls visit(k)
/// for the places k in BoxTree::order of all leaves that pass enter(node), as do the nodes above them, until
/// it returns true; returns whether it did.
template <class Nodes, class Enter, class Visit>
bool search_boxes(const Nodes& nodes, const Enter& enter, const Visit& visit) {
  if (nodes.empty()) return false;
  std::array<std::uint32_t, BoxTree::kMaxPath> waiting;
  std::size_t count = 0;
  waiting[count++] = 0;
  while (count != 0) {
    const auto& node = nodes[waiting[--count]];
    if (!enter(node)) continue;
    if (node.count == 0) {
      waiting[count++] = node.first + 1;
      waiting[count++] = node.first;
      continue;
    }
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k)
      if (visit(k)) return true;
  }
  return false;
}

}  // namespace fluxel
