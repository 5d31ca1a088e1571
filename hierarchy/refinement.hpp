#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hierarchy/link.hpp"
#include "hierarchy/link_oracle.hpp"
#include "hierarchy/node_light.hpp"
#include "hierarchy/node_tree.hpp"
#include "visibility/occluder.hpp"
#include "visibility/patch_tree.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// Why a link is as fine as it is, and what it took.
struct RefinementCounts {
  std::uint64_t pairs = 0;     ///< of nodes that were looked at
  std::uint64_t shafts = 0;    ///< that were built
  std::uint64_t contours = 0;  ///< contour integrals
  std::uint64_t rays = 0;

  RefinementCounts& operator+=(const RefinementCounts& other);
};

/// A pair that has been come to on the way down, and not been looked at yet.
struct PendingPair {
  NodePair nodes;
  bool free = false;  ///< nothing stands between the two, as has been found further up
};

/// A halving that a pair asks for, and how much: pairs that share a leaf may ask for different ones.
struct WantedHalving {
  Halving halving;
  std::uint64_t weight = 1;
};

/// What refining a list of pairs gave.
struct RefinedPairs {
  std::vector<Link> links;            ///< good enough
  std::vector<NodePair> open;         ///< that ask for halves which the tree does not have yet
  std::vector<WantedHalving> wanted;  ///< the leaves to be halved
  std::vector<PendingPair> pending;   ///< where the visits ended
  RefinementCounts counts;
};

/// Decides which pairs of nodes may exchange light as one.
class Refiner {
 public:
  /// All must outlive this.
  Refiner(const RayScene& ray_scene, const NodeTree& tree);

  /// Replaces a pair by links between the nodes that there are, and by what is still open. Depends on the
  /// arguments alone. May run from many threads at once.
  void refine(const NodePair& pair, std::span<const NodeLight> light, const RefinementGoal& goal,
              RefinedPairs& result) const;
  /// The same, but of at most so many pairs on the way down: others are left pending.
  void refine(const PendingPair& pair, std::span<const NodeLight> light, const RefinementGoal& goal,
              std::size_t visits, RefinedPairs& result) const;

  /// What tells whether a link is as fine as it has to be; the light must outlive it.
  [[nodiscard]] LinkOracle oracle(std::span<const NodeLight> light, const RefinementGoal& goal) const;

 private:
  class Descent;

  [[nodiscard]] double epsilon() const;  ///< [m]

  const RayScene& ray_scene_;
  const NodeTree& tree_;
  PatchTree patch_tree_;
  std::vector<Occluder> occluders_;
  double area_ = 0;  ///< of all faces [m2]
};

}  // namespace fluxel
