#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "hierarchy/link.hpp"
#include "hierarchy/linked_nodes.hpp"
#include "hierarchy/node_tree.hpp"
#include "solver/radiosity_operator.hpp"

namespace fluxel {

/// A link as one of its nodes has it: what that receives from the other.
struct LinkEnd {
  NodeId from = kNoNode;
  float F = 0;        ///< form factor from the receiver to `from`
  Slope here, there;  ///< of the kernel over the receiver and over `from`
  bool partial = false;
};

/// Links by the node that receives, each for both of its directions.
class LinkTable {
 public:
  LinkTable(const NodeTree& tree, std::span<const Link> links);

  [[nodiscard]] std::span<const LinkEnd> of(NodeId id) const {
    return std::span(ends_).subspan(first_[id], first_[id + 1] - first_[id]);
  }
  [[nodiscard]] std::size_t size() const { return ends_.size(); }

 private:
  std::vector<std::size_t> first_;  // of each node, and the number of links
  std::vector<LinkEnd> ends_;
};

/// Sums over ranks of whole numbers, in place.
using SumOverRanks = std::function<void(std::span<std::uint64_t>)>;

/// F as links: the means and first moments of the radiosity go up the tree, are exchanged between the nodes
/// of links, and what a node receives, a linear function over it, goes down to the leaves, which take its
/// mean. Links may lie on any rank: each contribution is rounded to a whole number of units, 2^-52 of the
/// largest that the node can receive, so that sums are the same in every order (Demmel & Nguyen 2013 name
/// such sums reproducible).
class LinkOperator final : public RadiosityOperator {
 public:
  /// All must outlive this. The linked nodes are those of all ranks' links.
  LinkOperator(const LinkedNodes& linked, const LinkTable& table, SumOverRanks sum, int threads);

  void apply(std::span<const Rgb> x, std::span<Rgb> H) override;
  void apply(std::span<const double> x, std::span<double> H) override;
  /// Also the slope of H over each unknown, for each colour along the axes of its piece, times the extents
  /// of its leaf.
  void apply_with_slopes(std::span<const Rgb> x, std::span<Rgb> H, std::span<std::array<Rgb, 2>> slopes);

  void sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) override;
  void sweep(std::span<const double> E, std::span<const double> rho, std::span<double> x) override;

 private:
  template <class Value>
  void apply_to(std::span<const Value> x, std::span<Value> H, std::span<std::array<Value, 2>> slopes = {});

  const LinkedNodes& linked_;
  const LinkTable& table_;
  SumOverRanks sum_;
  int threads_;
};

}  // namespace fluxel
