#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/ranks.hpp"
#include "core/rgb.hpp"
#include "hierarchy/node_tree.hpp"
#include "optics/luminaire_light.hpp"

namespace fluxel {

struct GatherPoint;
struct GatherGoal;

/// What luminaires bring straight to a face: a mean, what it rises by from the centroid to the extents along
/// the axes, and the standard deviation beyond that, mean of the colours [W/m2].
struct FirstLight {
  Rgb mean{0};
  std::array<Rgb, 2> slope{Rgb(0), Rgb(0)};
  double residual = 0;
};

/// By rays from points all over the face; depends on the arguments alone. Adds the rays to `traced`.
[[nodiscard]] FirstLight first_light(const LuminaireLight& luminaires, const NodeTree& tree, NodeId face,
                                     std::uint64_t& traced);

/// The first light of a tree's leaves, as far as it has been asked for.
class FirstLightOfLeaves {
 public:
  /// What is given must outlive this; the tree may be split.
  FirstLightOfLeaves(const LuminaireLight& luminaires, const NodeTree& tree)
      : luminaires_(luminaires), tree_(tree) {}

  [[nodiscard]] bool empty() const { return luminaires_.empty(); }

  /// Collective: of leaves that have come since the last call; each rank finds some. Returns the rays of
  /// this rank.
  std::uint64_t find(const Ranks& ranks, int threads);

  /// Of a leaf at the last call of `find`.
  [[nodiscard]] const FirstLight& of(NodeId leaf) const { return of_nodes_[leaf - tree_.clusters()]; }

  [[nodiscard]] std::uint64_t bytes() const { return of_nodes_.size() * sizeof(FirstLight); }

 private:
  const LuminaireLight& luminaires_;
  const NodeTree& tree_;
  std::vector<FirstLight> of_nodes_;  // of faces
};

/// Collective: what luminaires bring to points by two halves of rays, as PointGather has them; 0 where a
/// point has no face. Adds the rays of this rank to `traced`.
[[nodiscard]] std::array<std::vector<Rgb>, 2> first_light_of_points(
    const LuminaireLight& luminaires, const NodeTree& tree, std::span<const GatherPoint> points,
    const GatherGoal& goal, const Ranks& ranks, int threads, std::uint64_t& traced);

}  // namespace fluxel
