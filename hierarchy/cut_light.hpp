#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/rgb.hpp"
#include "hierarchy/node_light.hpp"
#include "hierarchy/node_tree.hpp"

namespace fluxel {

/// What a node receives its irradiance by: of a face one number for all of it, of a cluster six, towards both
/// sides of each axis, of which its faces take parts by the squares of their normals' components, which sum
/// to 1 (the ambient cube of McTaggart, Half-Life 2 / Valve Source Shading, 2004).
inline constexpr std::size_t kCubeSides = 6;
using CubeParts = std::array<double, 3>;

/// The sides of the cube that a normal looks to, one of each axis, and its parts of them.
[[nodiscard]] inline std::size_t cube_side(std::size_t axis, const glm::dvec3& normal) {
  return 2 * axis + (normal[static_cast<int>(axis)] < 0 ? 1 : 0);
}
[[nodiscard]] inline CubeParts cube_parts(const glm::dvec3& normal) {
  return {normal.x * normal.x, normal.y * normal.y, normal.z * normal.z};
}

/// Nodes each of which has a row: every leaf lies in or is exactly one of them. The unknowns are what they
/// receive: of a face its irradiance, of a cluster the six of its cube.
class TreeCut {
 public:
  static constexpr std::uint32_t kNoRow = 0xFFFFFFFFu;

  TreeCut() = default;
  /// `nodes` in any order.
  TreeCut(const NodeTree& tree, std::vector<NodeId> nodes, int threads);

  [[nodiscard]] std::span<const NodeId> nodes() const { return nodes_; }  ///< ascending
  /// The first unknown of each row, and behind the last one.
  [[nodiscard]] std::span<const std::uint32_t> first() const { return first_; }
  [[nodiscard]] std::size_t unknowns() const { return first_.empty() ? 0 : first_.back(); }

  /// The number of the node that a face lies in or is; kNoRow of a face above the cut. Halves that have been
  /// made since lie where the whole does.
  [[nodiscard]] std::uint32_t row_of(const NodeTree& tree, NodeId face) const {
    while (face - tree.clusters() >= row_of_.size()) face = tree[face].parent;
    return row_of_[face - tree.clusters()];
  }
  /// Likewise of any node below the cut or of it, by a search up the tree.
  [[nodiscard]] std::uint32_t find_row(const NodeTree& tree, NodeId node) const;

  /// What a face with this normal has of the unknowns' values, in node number `row`.
  template <class Value>
  [[nodiscard]] Value part(std::uint32_t row, const glm::dvec3& normal, std::span<const Value> values) const {
    const std::uint32_t from = first_[row];
    if (first_[row + 1] - from == 1) return values[from];
    const CubeParts parts = cube_parts(normal);
    Value sum(0);
    for (std::size_t axis = 0; axis < parts.size(); ++axis)
      sum += parts[axis] * values[from + cube_side(axis, normal)];
    return sum;
  }

 private:
  std::vector<NodeId> nodes_;
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> row_of_;  // of each face
};

/// The light of a solution on a cut. What it looks at must outlive it.
class CutLight {
 public:
  /// `irradiance` of the cut's unknowns [W/m2]; `powers` that its nodes reflect, in size [W].
  CutLight(const NodeTree& tree, const TreeCut& cut, std::span<const Rgb> irradiance,
           std::span<const double> powers)
      : tree_(&tree), cut_(&cut), irradiance_(irradiance), powers_(powers) {}

  [[nodiscard]] Rgb irradiance(NodeId leaf) const {
    return cut_->part(cut_->row_of(*tree_, leaf), (*tree_)[leaf].shape.normal, irradiance_);
  }
  [[nodiscard]] Rgb reflected(NodeId leaf) const { return tree_->material(leaf).rho * irradiance(leaf); }

  [[nodiscard]] const TreeCut& cut() const { return *cut_; }
  /// Of each node about, by the mean reflectance of its faces: a size, mean of the colours [W].
  [[nodiscard]] std::span<const double> reflected_powers() const { return powers_; }

 private:
  const NodeTree* tree_;
  const TreeCut* cut_;
  std::span<const Rgb> irradiance_;
  std::span<const double> powers_;
};

/// The leaves as a cut, with the light that they have as unknowns.
class LeafCut {
 public:
  /// `irradiance` of the unknowns [W/m2].
  LeafCut(const NodeTree& tree, const LeafUnknowns& leaves, std::span<const Rgb> irradiance, int threads);

  /// Of a tree that has not been split since; this must outlive it.
  [[nodiscard]] CutLight light() const { return {*tree_, cut_, irradiance_, powers_}; }

 private:
  const NodeTree* tree_;
  TreeCut cut_;
  std::vector<Rgb> irradiance_;  // of the cut's nodes
  std::vector<double> powers_;   // likewise
};

}  // namespace fluxel
