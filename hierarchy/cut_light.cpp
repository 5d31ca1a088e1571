#include "hierarchy/cut_light.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <glm/common.hpp>
#include <utility>

namespace fluxel {

TreeCut::TreeCut(const NodeTree& tree, std::vector<NodeId> nodes, int threads) : nodes_(std::move(nodes)) {
  std::ranges::sort(nodes_);
  first_.reserve(nodes_.size() + 1);
  first_.push_back(0);
  for (const NodeId node : nodes_)
    first_.push_back(first_.back() + (tree.is_cluster(node) ? static_cast<std::uint32_t>(kCubeSides) : 1));
  row_of_.assign(tree.size() - tree.clusters(), kNoRow);
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, nodes_.size()), [&](const auto& range) {
      for (std::size_t k = range.begin(); k < range.end(); ++k)
        if (const auto row = static_cast<std::uint32_t>(k); tree.is_cluster(nodes_[k])) {
          for (const NodeId face : tree.faces_of_cluster(nodes_[k])) row_of_[face - tree.clusters()] = row;
        } else {
          row_of_[nodes_[k] - tree.clusters()] = row;
        }
    });
  });
  // Halves of faces, parents first: a face that lies below the cut may have been halved as a twin.
  for (std::size_t id = tree.whole(); id < tree.size(); ++id)
    if (const NodeId parent = tree[static_cast<NodeId>(id)].parent; row_of_[id - tree.clusters()] == kNoRow)
      row_of_[id - tree.clusters()] = row_of_[parent - tree.clusters()];
}

std::uint32_t TreeCut::find_row(const NodeTree& tree, NodeId node) const {
  for (NodeId id = node; id != kNoNode; id = tree[id].parent)
    if (const auto found = std::ranges::lower_bound(nodes_, id); found != nodes_.end() && *found == id)
      return static_cast<std::uint32_t>(found - nodes_.begin());
  return kNoRow;
}

namespace {

std::vector<NodeId> unknown_leaves(const LeafUnknowns& leaves) {
  std::vector<NodeId> nodes(leaves.nodes().begin(), leaves.nodes().end());
  std::erase(nodes, kNoNode);
  return nodes;
}

}  // namespace

LeafCut::LeafCut(const NodeTree& tree, const LeafUnknowns& leaves, std::span<const Rgb> irradiance,
                 int threads)
    : tree_(&tree),
      cut_(tree, unknown_leaves(leaves), threads),
      irradiance_(cut_.nodes().size()),
      powers_(cut_.nodes().size()) {
  for (std::size_t k = 0; k < irradiance.size(); ++k) {
    const NodeId leaf = leaves.nodes()[k];
    if (leaf == kNoNode) continue;
    const std::uint32_t row = cut_.row_of(tree, leaf);
    irradiance_[row] = irradiance[k];
    powers_[row] = mean_of_colours(glm::abs(tree.material(leaf).rho * irradiance[k])) * tree[leaf].shape.area;
  }
}

}  // namespace fluxel
