#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "hierarchy/hierarchy.hpp"
#include "hierarchy/link_operator.hpp"

namespace fluxel {

/// Light is exchanged by links between nodes; each link is on one rank.
class LinkHierarchy final : public Hierarchy {
 public:
  LinkHierarchy(Ranks ranks, const Scene& scene, const RayScene& ray_scene, int threads,
                const OracleParts& oracle);

  void look_again() override;
  void restore(KeptRounds kept, std::vector<Link> links, const RefinementCounts& counts) override;
  [[nodiscard]] bool refine(double error, std::uint64_t bytes, Progress& progress) override;
  void solve(Solver solver, const StopRule& stop, const IterationObserver& observer) override;
  [[nodiscard]] std::array<std::vector<Rgb>, 2> gather_halves(std::span<const GatherPoint> points,
                                                              const GatherGoal& goal,
                                                              Progress& progress) override;
  [[nodiscard]] std::vector<Rgb> gather(std::span<const GatherPoint> points, const GatherGoal& goal,
                                        Progress& progress) override;

  [[nodiscard]] bool by_rays() const override { return false; }
  [[nodiscard]] Rgb mean_radiosity() const override { return area_mean(leaves_.unknowns(), radiosity_->B); }
  [[nodiscard]] LeafLight leaf_light() const override {
    return {leaves_, *radiosity_, row_sums_, uncapped_sums_.empty() ? row_sums_.sums : uncapped_sums_};
  }
  [[nodiscard]] std::span<const Link> own_links() const override { return links_; }
  [[nodiscard]] std::uint64_t links() const override { return all_links_; }
  [[nodiscard]] std::uint64_t bytes() const override;

 private:
  struct Pass;
  /// Of leaves that are to be halved, what asks for each edge.
  using Votes = std::map<NodeId, std::array<std::uint64_t, 3>>;

  /// What iterations begin with; empty before the first solution.
  [[nodiscard]] std::vector<Rgb> radiosity_of_leaves() const;
  void take(Radiosity radiosity);
  /// Halves leaves, with their twins; halves have the light of the whole.
  void grow(std::span<const Halving> wanted);
  /// By an operator that, times areas, is symmetric, or would be but for its noise.
  void update_importance(RadiosityOperator& F);
  /// Of all nodes, as it is gathered.
  [[nodiscard]] std::vector<Rgb> gathered_radiosity(LightFrom from) const;
  [[nodiscard]] std::vector<std::array<Rgb, 2>> gathered_slopes(LightFrom from) const;
  [[nodiscard]] std::vector<Rgb> gather_some(const Gatherer& gatherer, const Gatherer& onwards,
                                             std::span<const GatherPoint> on_leaves, int bounces,
                                             std::uint64_t& parts);
  [[nodiscard]] std::vector<Rgb> gather_by_links(const Gatherer& gatherer,
                                                 std::span<const GatherPoint> on_leaves, std::uint64_t part,
                                                 std::vector<NearPlace>* near);
  void share_out();
  [[nodiscard]] std::vector<NodePair> first_pairs() const;
  [[nodiscard]] std::vector<NodePair> reopen(const RefinementGoal& goal);
  [[nodiscard]] bool run(Pass& pass, const RefinementGoal& goal, std::uint64_t bytes, Progress& progress);
  void refine_batch(Pass& pass, std::size_t pairs, std::size_t visits, const RefinementGoal& goal);
  [[nodiscard]] std::vector<Halving> wanted_by_any(const Votes& votes) const;
  [[nodiscard]] std::size_t count_halves(std::span<const Halving> wanted) const;
  void settle(std::vector<NodePair> open, RefinementGoal goal, std::uint64_t bytes, Progress& progress);
  void make_table();
  void take_radiosity(const std::function<Radiosity(RadiosityOperator&)>& find);
  [[nodiscard]] LinkedNodes linked_nodes() const;
  [[nodiscard]] std::vector<double> scale_rows(RadiosityOperator& F);
  void update_light(LinkOperator& F);
  void find_first_light();
  /// Of all nodes, by the radiosity of the unknowns and the slopes of their irradiance by links.
  void take_light(std::span<const Rgb> B, std::span<std::array<Rgb, 2>> slopes);

  Refiner refiner_;
  LuminaireLight luminaires_;
  FirstLightOfLeaves first_light_;
  LeafUnknowns leaves_;
  std::vector<NodeLight> light_;  // of all nodes
  std::vector<Rgb> B_;            // likewise; none before the first solution
  RowSums row_sums_;
  std::vector<std::array<Rgb, 2>> slopes_;  // of the radiosity over each node that is a leaf
  std::vector<Link> links_;                 // of this rank
  std::uint64_t all_links_ = 0;
  std::optional<LinkTable> table_;
  std::vector<double> uncapped_sums_;  // empty where nothing was capped or closed
};

}  // namespace fluxel
