#include "hierarchy/node_light.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "hierarchy/face_pair.hpp"
#include "hierarchy/seen_slope.hpp"

namespace fluxel {

LeafUnknowns::LeafUnknowns(const NodeTree& tree) {
  const std::vector<ElementNodes> of_elements = tree.element_nodes();
  // What unknowns are made of.
  std::vector<Element> elements(of_elements.size());
  for (std::size_t k = 0; k < elements.size(); ++k) {
    const auto [front, back] = of_elements[k];
    elements[k].sides = (front != kNoNode ? kFront : 0u) | (back != kNoNode ? kBack : 0u);
    const NodeId node = front != kNoNode ? front : back;
    if (node == kNoNode) continue;
    elements[k].area = static_cast<float>(tree[node].shape.area);
    elements[k].material = tree.material_id(node);
  }
  unknowns_ = make_unknowns(elements, tree.scene().materials);
  nodes_.assign(unknowns_.size(), kNoNode);
  for (std::size_t k = 0; k < of_elements.size(); ++k) {
    nodes_[k] = of_elements[k].front;
    if (unknowns_.two_sided) nodes_[of_elements.size() + k] = of_elements[k].back;
  }
}

void LeafUnknowns::take(const FirstLightOfLeaves& first) {
  if (first.empty()) return;
  unknowns_.H0.assign(unknowns_.size(), Rgb(0));
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    if (nodes_[k] != kNoNode) unknowns_.H0[k] = first.of(nodes_[k]).mean;
}

std::vector<NodeLight> light_of_nodes(const NodeTree& tree, const LeafUnknowns& leaves,
                                      std::span<const Rgb> B, std::span<const std::array<Rgb, 2>> slopes) {
  const Unknowns& unknowns = leaves.unknowns();
  std::vector<double> mean(tree.size()), variance(tree.size());
  std::vector<NodeLight> light(tree.size());
  for (std::size_t k = 0; k < B.size(); ++k) {
    const NodeId id = leaves.nodes()[k];
    if (id == kNoNode) continue;
    mean[id] = mean_of_colours(B[k]);
    light[id].rho = static_cast<float>(mean_of_colours(unknowns.rho[k]));
    if (slopes.empty()) continue;
    const glm::dvec2 slope(mean_of_colours(unknowns.rho[k] * slopes[k][0]),
                           mean_of_colours(unknowns.rho[k] * slopes[k][1]));
    variance[id] = glm::dot(slope, tree.covariance(id) * slope);
  }
  for (std::size_t id = tree.size(); id-- > 0;) {
    const Node& node = tree[static_cast<NodeId>(id)];
    if (node.is_leaf()) continue;
    const auto [a, b] = node.child;
    const double share = tree[b].shape.area / node.shape.area;
    mean[id] = (1 - share) * mean[a] + share * mean[b];
    light[id].rho = static_cast<float>((1 - share) * light[a].rho + share * light[b].rho);
    const double apart = mean[a] - mean[b];
    variance[id] = (1 - share) * variance[a] + share * variance[b] + share * (1 - share) * apart * apart;
  }
  for (std::size_t id = 0; id < tree.size(); ++id) {
    light[id].B = static_cast<float>(std::abs(mean[id]));
    light[id].deviation = static_cast<float>(std::sqrt(variance[id]));
  }
  return light;
}

void forget_power(double mean, std::span<NodeLight> light) {
  constexpr double kDeviation = 0.2;
  for (NodeLight& of_node : light) {
    of_node.B = static_cast<float>(mean);
    of_node.deviation = static_cast<float>(kDeviation * mean);
  }
}

std::vector<std::array<Rgb, 2>> slopes_of_leaves(const NodeTree& tree, const LeafUnknowns& leaves,
                                                 std::span<const Rgb> B,
                                                 std::span<const std::array<Rgb, 2>> slopes_of_irradiance) {
  std::vector<std::array<Rgb, 2>> slopes(B.size(), {Rgb(0), Rgb(0)});
  for (std::size_t k = 0; k < B.size(); ++k) {
    const NodeId id = leaves.nodes()[k];
    if (id == kNoNode) continue;
    const auto& [u, v] = slopes_of_irradiance[k];
    for (int c = 0; c < kChannels; ++c) {
      const double rho = leaves.unknowns().rho[k][c], mean = B[k][c], sign = mean < 0 ? -1 : 1;
      const glm::dvec2 slope = rho * glm::dvec2(u[c], v[c]);
      const double depth = largest_drop(tree, id, sign * slope);
      const double part = depth > std::abs(mean) ? std::abs(mean) / depth : 1;
      slopes[k][0][c] = part * slope.x;
      slopes[k][1][c] = part * slope.y;
    }
  }
  return slopes;
}

void add_squared_residuals(const NodeTree& tree, std::span<const Link> links,
                           std::span<const NodeLight> light, double epsilon, double unit,
                           std::span<std::uint64_t> sums) {
  constexpr double kShare = 0.5;
  constexpr double kLargest = 0x1p40;  // so that sums of many cannot overflow
  for (const Link& link : links) {
    if (tree.is_cluster(link.p) || tree.is_cluster(link.q)) continue;
    const FacePair pair = estimate_face_pair(tree, link.p, link.q, epsilon);
    if (!(pair.G > 0)) continue;
    const auto add = [&](NodeId to, NodeId from, double residual) {
      if (!tree[to].is_leaf()) return;
      const double H = static_cast<double>(link.G) / tree[to].shape.area * static_cast<double>(light[from].B);
      const double deviation = kShare * static_cast<double>(light[to].rho) * H * residual / pair.G / unit;
      sums[to] += static_cast<std::uint64_t>(std::min(deviation * deviation, kLargest));
    };
    add(link.p, link.q, pair.p.residual);
    add(link.q, link.p, pair.q.residual);
  }
}

void add_to_deviation(const NodeTree& tree, std::span<const std::uint64_t> squared_residuals, double unit,
                      std::span<NodeLight> light) {
  for (std::size_t id = tree.clusters(); id < tree.size(); ++id) {
    const double squared = unit * unit * static_cast<double>(squared_residuals[id]);
    const auto deviation = static_cast<double>(light[id].deviation);
    light[id].deviation = static_cast<float>(std::sqrt(deviation * deviation + squared));
  }
}

}  // namespace fluxel
