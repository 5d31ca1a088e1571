#pragma once

#include <vector>

#include "hierarchy/hierarchy.hpp"
#include "hierarchy/ray_operator.hpp"

namespace fluxel {

/// Light is exchanged by rays: the nodes of a cut through the tree, clusters where that is enough, each ask
/// rays for their row of F. What that costs depends on the light, and hardly on how many faces the scene has.
/// A row is on one rank.
class RayHierarchy final : public Hierarchy {
 public:
  RayHierarchy(Ranks ranks, const Scene& scene, const RayScene& ray_scene, int threads,
               const OracleParts& oracle);

  void look_again() override;
  void restore(KeptRounds kept, std::vector<Link> links, const RefinementCounts& counts) override;
  [[nodiscard]] bool refine(double error, std::uint64_t bytes, Progress& progress) override;
  /// By Jacobi's iteration, whatever solver is asked for: rows of rays are not symmetric.
  void solve(Solver solver, const StopRule& stop, const IterationObserver& observer) override;
  /// By rays over the hemispheres of the points, as many as the goal's error takes. Where they end close by,
  /// one ray goes on, over at most four bounces: the radiosity of a leaf may be far from that of its places.
  [[nodiscard]] std::array<std::vector<Rgb>, 2> gather_halves(std::span<const GatherPoint> points,
                                                              const GatherGoal& goal,
                                                              Progress& progress) override;
  [[nodiscard]] std::vector<Rgb> gather(std::span<const GatherPoint> points, const GatherGoal& goal,
                                        Progress& progress) override;

  [[nodiscard]] std::span<const NodeId> cut() const override { return cut_.nodes; }
  [[nodiscard]] std::uint64_t bytes() const override;
  [[nodiscard]] double share_of_rays() const override { return 0.5; }

 private:
  [[nodiscard]] std::vector<NodeId> first_cut() const;
  void trace(std::span<const NodeId> nodes, Progress& progress);
  [[nodiscard]] std::vector<NodeId> wanted(double error, std::size_t first_row) const;
  void divide(std::span<const NodeId> nodes, Progress& progress);
  void order_rows();
  void update_importance_on_cut(RayOperator& F, const RowSums& of_cut);
  [[nodiscard]] RowSums sums_of_leaves(const RayOperator& F) const;

  RayLight ray_light_;
  std::vector<NodeId> nodes_;  // of the cut, in no order
  TreeCut cut_;                // of the last solve
  std::vector<RayRow> rows_;   // of this rank
};

}  // namespace fluxel
