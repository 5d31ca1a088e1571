#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "hierarchy/node_light.hpp"
#include "hierarchy/node_tree.hpp"

namespace fluxel {

/// A leaf of a bundle: what its face has of what the bundle's cluster exchanges.
struct BundledLeaf {
  std::uint32_t unknown = 0;
  double cluster_over_face = 1;  ///< area of the cluster over that of the whole face
  double part_of_face = 1;       ///< area of the leaf over that of the whole face
  WayShares shares{};            ///< of the whole face
};

/// A node that links reach.
struct LinkedNode {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  NodeId id = kNoNode;
  std::array<std::uint32_t, 2> child{kNone, kNone};  ///< places among the linked nodes
  std::uint32_t unknown = kNone;                     ///< of a face that is a leaf
  std::size_t first_leaf = 0, leaves = 0;            ///< of a bundle
};

/// The part of a tree that an exchange of light has to go through: the root, and the children of nodes below
/// which any has links. A cluster below which nothing has a link is a bundle: each of its leaves
/// has a fixed part of what the cluster exchanges by each way, so that its nodes are left out. The work
/// follows the links, not the faces that the scene is made of.
class LinkedNodes {
 public:
  /// `has_links`: an entry a node, not 0 where any rank has a link of it. The tree must outlive this.
  LinkedNodes(const NodeTree& tree, const LeafUnknowns& leaves, std::span<const std::uint64_t> has_links);

  /// In the order of their numbers in the tree: clusters first, parents before their children.
  [[nodiscard]] std::span<const LinkedNode> nodes() const { return nodes_; }
  [[nodiscard]] std::size_t clusters() const { return clusters_; }
  [[nodiscard]] std::span<const BundledLeaf> leaves_of(const LinkedNode& bundle) const {
    return std::span(bundled_).subspan(bundle.first_leaf, bundle.leaves);
  }
  /// Of a node of the tree; kNone where it is left out.
  [[nodiscard]] std::uint32_t place(NodeId id) const { return places_[id]; }

  [[nodiscard]] const NodeTree& tree() const { return tree_; }

 private:
  void bundle(NodeId id, BundledLeaf part, double cluster_area, std::span<const std::uint32_t> unknown_of);

  const NodeTree& tree_;
  std::vector<LinkedNode> nodes_;
  std::vector<BundledLeaf> bundled_;
  std::vector<std::uint32_t> places_;  // of each node of the tree
  std::size_t clusters_ = 0;
};

}  // namespace fluxel
