#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/ranks.hpp"
#include "hierarchy/ray_row.hpp"
#include "solver/radiosity_operator.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

/// Nodes each of which has a row: every leaf lies in or is exactly one of them. The unknowns are what they
/// receive: of a face its irradiance, of a cluster the six of its cube.
struct TreeCut {
  std::vector<NodeId> nodes;           ///< ascending
  std::vector<std::uint32_t> first;    ///< the first unknown of each node, and behind the last one
  std::vector<std::uint32_t> of_node;  ///< of each node of the tree, the number in `nodes` of the one that it
                                       ///< lies in or is; above the cut kNoNode

  TreeCut() = default;
  TreeCut(const NodeTree& tree, std::vector<NodeId> of_tree);

  [[nodiscard]] std::size_t unknowns() const { return first.empty() ? 0 : first.back(); }

  /// What a leaf with this normal has of the unknowns' values, in node number `row`.
  template <class Value>
  [[nodiscard]] Value part(std::uint32_t row, const glm::dvec3& normal, std::span<const Value> values) const {
    const std::uint32_t from = first[row];
    if (first[row + 1] - from == 1) return values[from];
    const CubeParts parts = cube_parts(normal);
    Value sum(0);
    for (std::size_t axis = 0; axis < parts.size(); ++axis)
      sum += parts[axis] * values[from + cube_side(axis, normal)];
    return sum;
  }
};

/// F as rays have it, times the reflectance of what they end on: from the irradiance of a cut to what that
/// becomes there once it has been reflected. So its size is that of the cut, and not of the tree below. A row
/// is on one rank and summed by one thread, so that the result has the same bytes for every number of them.
/// No row sum is above the largest reflectance.
class RayOperator final : public RadiosityOperator {
 public:
  /// All must outlive this. `rows` are this rank's, in the order of the cut.
  RayOperator(const NodeTree& tree, const TreeCut& cut, std::span<const RayRow> rows, const Ranks& ranks,
              int threads);

  [[nodiscard]] bool is_grey() const override;
  void apply(std::span<const Rgb> x, std::span<Rgb> H) override;
  void apply(std::span<const double> x, std::span<double> H) override;
  void sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) override;
  void sweep(std::span<const double> E, std::span<const double> rho, std::span<double> x) override;

  /// H = D + F H as a system of B = E + rho F B: with D, the irradiance of the cut by emission, as what is
  /// emitted, and no reflectance beside the operator's own.
  [[nodiscard]] Unknowns system() const;
  /// The irradiance of the cut by what leaves send and reflect: `sent` has an entry a node [W/m2].
  [[nodiscard]] std::vector<Rgb> reflected(std::span<const double> sent) const;
  /// Of each unknown, the part of its rays that end on a leaf.
  [[nodiscard]] std::vector<double> row_sums() const;

 private:
  /// What a ray ends on, and where its light comes from.
  struct Sender {
    std::uint32_t row = 0, material = 0;
    glm::vec3 normal{0};
  };
  template <class Value>
  void apply_to(std::span<const Value> x, std::span<Value> H) const;
  template <class Value>
  void sweep_over(std::span<const Value> E, std::span<const Value> rho, std::span<Value> x) const;
  /// The mean over the rays of each unknown of what `value` gives for a ray's number among this rank's and
  /// its end.
  template <class Value, class Function>
  [[nodiscard]] std::vector<Value> means(const Function& value) const;
  /// From the unknowns of this rank's rows to all.
  template <class Value>
  [[nodiscard]] std::vector<Value> of_all(std::span<const Value> own) const;

  const NodeTree& tree_;
  const TreeCut& cut_;
  std::span<const RayRow> rows_;
  const Ranks& ranks_;
  int threads_;
  std::vector<std::size_t> first_end_, first_own_;  // of each row: among this rank's rays, and unknowns
  std::vector<Sender> senders_;                     // of the rays
  std::vector<double> largest_rho_;                 // of the materials
};

}  // namespace fluxel
