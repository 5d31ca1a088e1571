#include "hierarchy/emitter_draw.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/sampling.hpp"

namespace fluxel {

EmitterDraw::EmitterDraw(const NodeTree& tree) : tree_(tree), power_(tree.whole()) {
  for (std::size_t k = power_.size(); k-- > 0;) {
    const auto id = static_cast<NodeId>(k);
    if (tree.is_cluster(id)) {
      const auto [a, b] = tree[id].child;
      power_[k] = power_[a] + power_[b];
    } else {
      power_[k] = mean_of_colours(glm::abs(tree.emission(id))) * tree[id].shape.area;
    }
  }
}

/// Of the two's choice. Nearer than half its radius a node is taken to be that far away.
double EmitterDraw::share(NodeId child, NodeId sibling, const glm::dvec3& from) const {
  const auto weight = [&](NodeId id) {
    const glm::dvec3 d = tree_[id].shape.centroid - from;
    const double reach = 0.5 * tree_[id].radius;
    return power_[id] / std::max(glm::dot(d, d), reach * reach);
  };
  if (!(power_[sibling] > 0)) return 1;
  if (!(power_[child] > 0)) return 0;
  const double of_child = weight(child);
  return of_child / (of_child + weight(sibling));
}

DrawnEmitter EmitterDraw::draw(const glm::dvec3& from, double choice, double u, double v) const {
  NodeId id = 0;
  double chance = 1;
  while (tree_.is_cluster(id)) {
    const auto [a, b] = tree_[id].child;
    const double of_a = share(a, b, from);
    const bool first = choice < of_a;
    choice = first ? choice / of_a : (choice - of_a) / (1 - of_a);
    chance *= first ? of_a : 1 - of_a;
    id = first ? a : b;
  }
  return {id, surface_point(tree_.outline(id), u, v), chance / tree_[id].shape.area};
}

double EmitterDraw::density(NodeId face, const glm::dvec3& from) const {
  double chance = 1 / tree_[face].shape.area;
  for (NodeId id = face; tree_[id].parent != kNoNode; id = tree_[id].parent) {
    const auto [a, b] = tree_[tree_[id].parent].child;
    chance *= share(id, id == a ? b : a, from);
  }
  return chance;
}

}  // namespace fluxel
