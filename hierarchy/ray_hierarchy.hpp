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
  /// See RayGather: the radiosity of a leaf may be far from that of its places.
  [[nodiscard]] std::array<std::vector<Rgb>, 2> gather_halves(std::span<const GatherPoint> points,
                                                              const GatherGoal& goal,
                                                              Progress& progress) override;
  [[nodiscard]] std::vector<Rgb> gather(std::span<const GatherPoint> points, const GatherGoal& goal,
                                        Progress& progress) override;

  [[nodiscard]] std::span<const NodeId> cut() const override { return cut_.nodes(); }
  [[nodiscard]] std::optional<CutLight> cut_light() const override;
  [[nodiscard]] bool by_rays() const override { return true; }
  [[nodiscard]] Rgb mean_radiosity() const override { return mean_radiosity_; }
  [[nodiscard]] LeafLight leaf_light() const override;
  [[nodiscard]] std::uint64_t bytes() const override;
  [[nodiscard]] double share_of_rays() const override { return 0.5; }

 private:
  [[nodiscard]] std::vector<NodeId> first_cut() const;
  void trace(std::span<const NodeId> nodes, Progress& progress);
  [[nodiscard]] std::vector<NodeId> wanted(double error, std::size_t first_row) const;
  void divide(std::span<const NodeId> nodes, Progress& progress);
  void order_rows();
  void take(Radiosity radiosity);
  void update_importance(RayOperator& F, const Unknowns& system, const RowSums& sums);
  [[nodiscard]] Rgb reflectance(NodeId node) const {
    return tree_.is_cluster(node) ? Rgb(rho_of_clusters_[node]) : tree_.material(node).rho;
  }

  RayLight ray_light_;
  std::vector<glm::vec3> rho_of_clusters_;  // mean reflectance
  Rgb emission_{0}, mean_radiosity_{0};     // means over all surfaces [W/m2]
  std::vector<NodeId> nodes_;               // of the cut, in no order
  std::vector<RayRow> rows_;                // of this rank
  // Of the last solve:
  TreeCut cut_;
  std::vector<double> area_;       // of the unknowns: what of the node's faces looks to that side [m2]
  std::vector<double> row_sums_;   // likewise
  std::vector<double> powers_;     // that the nodes reflect, in size [W]
  std::vector<float> importance_;  // of the nodes, see NodeLight; none: 1
};

}  // namespace fluxel
