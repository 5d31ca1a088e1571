#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/ranks.hpp"
#include "hierarchy/node_light.hpp"
#include "hierarchy/ray_row.hpp"
#include "solver/radiosity_operator.hpp"

namespace fluxel {

/// Nodes each of which has a row: every leaf lies in or is exactly one of them.
struct TreeCut {
  std::vector<NodeId> nodes;           ///< ascending
  std::vector<std::uint32_t> of_leaf;  ///< of each unknown leaf, the number of its node; none: kNoNode

  TreeCut() = default;
  TreeCut(const NodeTree& tree, const LeafUnknowns& leaves, std::vector<NodeId> of_tree);
};

/// F as rays have it, without what emitters emit: what the leaves reflect comes in, the irradiance of the
/// nodes of a cut goes out to the leaves. A row is on one rank and summed by one thread, so that the result
/// has the same bytes for every number of them. No row sum is above 1.
class RayOperator final : public RadiosityOperator {
 public:
  /// All must outlive this. `rows` are this rank's, in the order of the cut.
  RayOperator(const NodeTree& tree, const LeafUnknowns& leaves, const TreeCut& cut,
              std::span<const RayRow> rows, const Ranks& ranks, int threads);

  void apply(std::span<const Rgb> x, std::span<Rgb> H) override;
  void apply(std::span<const double> x, std::span<double> H) override;
  void sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) override;
  void sweep(std::span<const double> E, std::span<const double> rho, std::span<double> x) override;

  /// The irradiance of the leaves by emission.
  [[nodiscard]] std::vector<Rgb> emitted() const;

 private:
  template <class Value>
  using Cube = std::array<Value, kCubeSides>;
  template <class Value>
  void apply_to(std::span<const Value> x, std::span<Value> H) const;
  template <class Value>
  void sweep_over(std::span<const Value> E, std::span<const Value> rho, std::span<Value> x) const;
  /// From the irradiance of this rank's rows to that of all leaves.
  template <class Value>
  void hand_out(const std::vector<Cube<Value>>& own, std::span<Value> H) const;

  const NodeTree& tree_;
  const LeafUnknowns& leaves_;
  const TreeCut& cut_;
  std::span<const RayRow> rows_;
  const Ranks& ranks_;
  int threads_;
  std::vector<std::uint32_t> unknown_of_node_;
};

}  // namespace fluxel
