#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/rgb.hpp"
#include "hierarchy/first_light.hpp"
#include "hierarchy/link.hpp"
#include "hierarchy/node_tree.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

/// The unknowns of a tree: the sides of its leaves, as those of its elements.
class LeafUnknowns {
 public:
  LeafUnknowns() = default;
  explicit LeafUnknowns(const NodeTree& tree);

  [[nodiscard]] const Unknowns& unknowns() const { return unknowns_; }
  /// Gives them what luminaires bring straight to each.
  void take(const FirstLightOfLeaves& first);
  /// The leaf of an unknown; kNoNode where the side is none.
  [[nodiscard]] std::span<const NodeId> nodes() const { return nodes_; }

 private:
  Unknowns unknowns_;
  std::vector<NodeId> nodes_;
};

/// What the light of an earlier, coarser solution says of the nodes, mean of the colours.
struct NodeLight {
  float B = 0;           ///< size of the mean radiosity, which fluxes that draw make negative [W/m2]
  float deviation = 0;   ///< estimated standard deviation of the radiosity over the node [W/m2]
  float rho = 0;         ///< mean reflectance
  float importance = 1;  ///< weight of an error there, relative to the scene's mean
};

/// For all nodes, from the radiosity of the unknowns and the slopes of their irradiance, if there are any
/// (see LinkOperator::apply_with_slopes).
[[nodiscard]] std::vector<NodeLight> light_of_nodes(const NodeTree& tree, const LeafUnknowns& leaves,
                                                    std::span<const Rgb> B,
                                                    std::span<const std::array<Rgb, 2>> slopes);

/// Without power all nodes send alike, and vary as light mostly does; `mean` radiosity [W/m2].
void forget_power(double mean, std::span<NodeLight> light);

/// Of the radiosity over each unknown's leaf, in the mean linear: what it rises by from the centroid to
/// the extents along the axes, from the slopes of its irradiance. Less where it would be negative at a corner
/// (or positive, of negative means).
[[nodiscard]] std::vector<std::array<Rgb, 2>> slopes_of_leaves(
    const NodeTree& tree, const LeafUnknowns& leaves, std::span<const Rgb> B,
    std::span<const std::array<Rgb, 2>> slopes_of_irradiance);

/// Adds to `sums`, an entry a node, what the light that leaves receive by these links has of deviation beyond
/// its slope, as squares in units [W/m2]: whole numbers, so that sums over ranks are the same in every order.
void add_squared_residuals(const NodeTree& tree, std::span<const Link> links,
                           std::span<const NodeLight> light, double epsilon, double unit,
                           std::span<std::uint64_t> sums);

/// Adds such sums to the deviations.
void add_to_deviation(const NodeTree& tree, std::span<const std::uint64_t> squared_residuals, double unit,
                      std::span<NodeLight> light);

/// Means over the nodes of what the unknowns have, up the tree; of clusters too.
template <class Value>
void pull(const NodeTree& tree, std::span<Value> of_nodes) {
  for (std::size_t id = tree.size(); id-- > 0;) {
    const Node& node = tree[static_cast<NodeId>(id)];
    if (node.is_leaf()) continue;
    const auto [a, b] = node.child;
    const double share = tree[b].shape.area / node.shape.area;
    of_nodes[id] = (1 - share) * of_nodes[a] + share * of_nodes[b];
  }
}

}  // namespace fluxel
