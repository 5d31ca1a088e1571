#include "hierarchy/ray_operator.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <utility>

namespace fluxel {

TreeCut::TreeCut(const NodeTree& tree, const LeafUnknowns& leaves, std::vector<NodeId> of_tree)
    : nodes(std::move(of_tree)) {
  std::ranges::sort(nodes);
  // Parents come before their children.
  std::vector<std::uint32_t> of_node(tree.size(), kNoNode);
  for (std::size_t k = 0; k < nodes.size(); ++k) of_node[nodes[k]] = static_cast<std::uint32_t>(k);
  for (std::size_t id = 0; id < tree.size(); ++id)
    if (const NodeId parent = tree[static_cast<NodeId>(id)].parent;
        of_node[id] == kNoNode && parent != kNoNode)
      of_node[id] = of_node[parent];
  of_leaf.reserve(leaves.nodes().size());
  for (const NodeId leaf : leaves.nodes()) of_leaf.push_back(leaf == kNoNode ? kNoNode : of_node[leaf]);
}

RayOperator::RayOperator(const NodeTree& tree, const LeafUnknowns& leaves, const TreeCut& cut,
                         std::span<const RayRow> rows, const Ranks& ranks, int threads)
    : tree_(tree),
      leaves_(leaves),
      cut_(cut),
      rows_(rows),
      ranks_(ranks),
      threads_(threads),
      unknown_of_node_(tree.size(), kNoNode) {
  for (std::size_t k = 0; k < leaves.nodes().size(); ++k)
    if (leaves.nodes()[k] != kNoNode) unknown_of_node_[leaves.nodes()[k]] = static_cast<std::uint32_t>(k);
}

template <class Value>
void RayOperator::hand_out(const std::vector<Cube<Value>>& own, std::span<Value> H) const {
  // Ranks one after another, the rows of each in the order of the cut.
  const std::vector<Cube<Value>> gathered = ranks_.gather(std::span<const Cube<Value>>(own));
  std::vector<Cube<Value>> of_cut(cut_.nodes.size());
  std::size_t next = 0;
  for (std::size_t rank = 0; rank < ranks_.size; ++rank)
    for (std::size_t k = 0; k < cut_.nodes.size(); ++k)
      if (cut_.nodes[k] % ranks_.size == rank) of_cut[k] = gathered[next++];
  tbb::task_arena arena(threads_);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, H.size(), 4096), [&](const auto& range) {
      for (std::size_t k = range.begin(); k < range.end(); ++k) {
        H[k] = Value(0);
        const std::uint32_t row = cut_.of_leaf[k];
        if (row == kNoNode) continue;
        if (!tree_.is_cluster(cut_.nodes[row])) {
          H[k] = of_cut[row][0];
          continue;
        }
        const glm::dvec3& normal = tree_[leaves_.nodes()[k]].shape.normal;
        const CubeParts parts = cube_parts(normal);
        for (std::size_t axis = 0; axis < parts.size(); ++axis)
          H[k] += parts[axis] * of_cut[row][cube_side(axis, normal)];
      }
    });
  });
}

template <class Value>
void RayOperator::apply_to(std::span<const Value> x, std::span<Value> H) const {
  std::vector<Cube<Value>> own(rows_.size());
  tbb::task_arena arena(threads_);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rows_.size(), 64), [&](const auto& range) {
      for (std::size_t k = range.begin(); k < range.end(); ++k) {
        const RayRow& row = rows_[k];
        Cube<Value>& cube = own[k];
        cube.fill(Value(0));
        if (tree_.is_cluster(row.node)) {
          for (const RayEnd& end : row.ends) {
            const glm::dvec3& normal = tree_[end.from].shape.normal;
            const CubeParts parts = cube_parts(normal);
            for (std::size_t axis = 0; axis < parts.size(); ++axis)
              cube[cube_side(axis, normal)] += parts[axis] * x[unknown_of_node_[end.leaf]];
          }
        } else {
          for (const RayEnd& end : row.ends) cube[0] += x[unknown_of_node_[end.leaf]];
        }
        for (std::size_t side = 0; side < kCubeSides; ++side)
          if (row.weight(side) > 0) cube[side] /= row.weight(side);
      }
    });
  });
  hand_out(own, H);
}

void RayOperator::apply(std::span<const Rgb> x, std::span<Rgb> H) { apply_to(x, H); }
void RayOperator::apply(std::span<const double> x, std::span<double> H) { apply_to(x, H); }

/// A whole product: there are no rows that could go before others without being asked for one by one.
template <class Value>
void RayOperator::sweep_over(std::span<const Value> E, std::span<const Value> rho, std::span<Value> x) const {
  std::vector<Value> H(x.size());
  apply_to(std::span<const Value>(x), std::span(H));
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = E[k] + rho[k] * H[k];
}

void RayOperator::sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) {
  sweep_over(E, rho, x);
}
void RayOperator::sweep(std::span<const double> E, std::span<const double> rho, std::span<double> x) {
  sweep_over(E, rho, x);
}

std::vector<Rgb> RayOperator::emitted() const {
  std::vector<Cube<Rgb>> own;
  own.reserve(rows_.size());
  for (const RayRow& row : rows_) own.push_back(row.emitted);
  std::vector<Rgb> H(leaves_.nodes().size());
  hand_out(own, std::span(H));
  return H;
}

}  // namespace fluxel
