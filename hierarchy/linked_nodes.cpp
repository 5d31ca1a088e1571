#include "hierarchy/linked_nodes.hpp"

namespace fluxel {

namespace {

constexpr std::uint32_t kNone = LinkedNode::kNone;

/// Nodes below which any has links.
std::vector<bool> with_links_below(const NodeTree& tree, std::span<const std::uint64_t> has_links) {
  std::vector<bool> below(tree.size());
  for (std::size_t k = tree.size(); k-- > 0;) {
    const NodeId parent = tree[static_cast<NodeId>(k)].parent;
    if (parent != kNoNode && (has_links[k] != 0 || below[k])) below[parent] = true;
  }
  return below;
}

}  // namespace

LinkedNodes::LinkedNodes(const NodeTree& tree, const LeafUnknowns& leaves,
                         std::span<const std::uint64_t> has_links)
    : tree_(tree), places_(tree.size(), kNone) {
  std::vector<std::uint32_t> unknown_of(tree.size(), kNone);
  for (std::size_t k = 0; k < leaves.nodes().size(); ++k)
    if (const NodeId id = leaves.nodes()[k]; id != kNoNode) unknown_of[id] = static_cast<std::uint32_t>(k);
  const std::vector<bool> links_below = with_links_below(tree, has_links);
  for (std::size_t k = 0; k < tree.size(); ++k) {
    const auto id = static_cast<NodeId>(k);
    const NodeId parent = tree[id].parent;
    // Of a face all parts: what it receives is a linear function over them.
    const bool part_of_face = parent != kNoNode && !tree.is_cluster(parent) && places_[parent] != kNone;
    if (parent != kNoNode && !links_below[parent] && !part_of_face) continue;
    const auto place = static_cast<std::uint32_t>(nodes_.size());
    places_[id] = place;
    nodes_.push_back({id, {kNone, kNone}, unknown_of[id], 0, 0});
    if (tree.is_cluster(id)) ++clusters_;
    if (parent == kNoNode) continue;
    LinkedNode& above = nodes_[places_[parent]];
    above.child[tree[parent].child[0] == id ? 0 : 1] = place;
  }
  for (LinkedNode& node : std::span(nodes_).first(clusters_)) {
    if (node.child[0] != kNone) continue;
    node.first_leaf = bundled_.size();
    BundledLeaf whole;
    whole.shares.fill(1);
    bundle(node.id, whole, tree[node.id].shape.area, unknown_of);
    node.leaves = bundled_.size() - node.first_leaf;
  }
}

/// Adds the leaves below a node that has `part` of the bundle. `cluster_area`: the bundle's [m2];
/// `unknown_of`: an entry a node.
void LinkedNodes::bundle(NodeId id, BundledLeaf part, double cluster_area,
                         std::span<const std::uint32_t> unknown_of) {
  const Node& node = tree_[id];
  if (node.is_leaf()) {
    part.unknown = unknown_of[id];
    bundled_.push_back(part);
    return;
  }
  for (const NodeId child : node.child) {
    BundledLeaf below = part;
    if (tree_.is_cluster(id)) {
      const WayShares shares = tree_.shares(child);
      for (std::size_t way = 0; way < kWays; ++way) below.shares[way] *= shares[way];
      below.cluster_over_face = cluster_area / tree_[child].shape.area;
    } else {
      below.part_of_face /= 2;
    }
    bundle(child, below, cluster_area, unknown_of);
  }
}

}  // namespace fluxel
