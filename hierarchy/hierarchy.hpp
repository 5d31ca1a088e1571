#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/progress.hpp"
#include "hierarchy/gather.hpp"
#include "hierarchy/kept_rounds.hpp"
#include "hierarchy/link_operator.hpp"
#include "hierarchy/node_tree.hpp"
#include "hierarchy/ranks.hpp"
#include "hierarchy/refinement.hpp"
#include "solver/closure.hpp"
#include "solver/iterate.hpp"

namespace fluxel {

/// What decides how fine a link is, beside its geometry.
struct OracleParts {
  bool power = true;       ///< the radiosity that is sent
  bool importance = true;  ///< what can be seen of an error
  bool heat = false;       ///< see RefinementGoal
};

/// Radiosity on a tree of nodes and links between them, refined and solved in turn. The tree and the light
/// are the same on all ranks, byte for byte and for every number of them; each link is on one rank. All
/// calls are collective.
class Hierarchy {
 public:
  /// The scene and the ray scene must outlive this.
  Hierarchy(Ranks ranks, const Scene& scene, const RayScene& ray_scene, int threads,
            const OracleParts& oracle);

  /// Points at whose radiosity an error matters, of any nodes that are faces, in place of those before;
  /// without any it matters everywhere alike.
  void set_importance_points(std::vector<GatherPoint> seen);

  /// For scenes that let no light out: in solves the row sums are made 1 where what they miss would cost more
  /// than this of the radiosity.
  void close_rows(double tolerance) { closure_tolerance_ = tolerance; }

  /// Looks at the radiosity that there is again, after one of the above: row sums and what can be seen of an
  /// error, by which the next refinement goes.
  void look_again();

  /// What all ranks are to call together between parts of refine and gather. When this rank has been asked to
  /// stop (see core/signals), the part is left unfinished, so that what is called has to throw.
  void handle_signals_by(std::function<void()> signals) { signal_handler_ = std::move(signals); }

  /// Takes up what a hierarchy of the same scene and points has come to, in place of the first refinement
  /// and solve. `links`, between the nodes that there were, are those of this rank, whoever had them.
  /// Throws InputError, on all ranks alike, where the tree is another.
  void restore(KeptRounds kept, std::vector<Link> links, const RefinementCounts& counts);

  /// Halves nodes and refines links until each leaves at most `error` (see RefinementGoal). Ends early, and
  /// says so by false, where a rank's links and the tree would take more than `bytes`: links are then about
  /// as fine everywhere as that allows.
  [[nodiscard]] bool refine(double error, std::uint64_t bytes, Progress& progress);

  /// The radiosity on the links that there are.
  void solve(Solver solver, const StopRule& stop, const IterationObserver& observer);

  /// The irradiance of points, of any nodes that are faces; 0 where a point has none.
  [[nodiscard]] std::vector<Rgb> gather(std::span<const GatherPoint> points, const GatherGoal& goal,
                                        Progress& progress);

  [[nodiscard]] const NodeTree& tree() const { return tree_; }
  [[nodiscard]] const LeafUnknowns& leaves() const { return leaves_; }
  [[nodiscard]] const Radiosity& radiosity() const { return *radiosity_; }
  [[nodiscard]] const RowSums& row_sums() const { return row_sums_; }
  /// Row sums of the links as they are; those of row_sums() may be capped or closed.
  [[nodiscard]] std::span<const double> link_row_sums() const {
    return uncapped_sums_.empty() ? row_sums_.sums : uncapped_sums_;
  }
  /// How the row sums of the last solve were made 1, where that was needed.
  [[nodiscard]] const std::optional<Closure>& closure() const { return closure_; }
  [[nodiscard]] Rgb mean_radiosity() const { return area_mean(leaves_.unknowns(), radiosity_->B); }
  [[nodiscard]] std::span<const Link> own_links() const { return links_; }
  /// Radiosity, the mean over each node [W/m2].
  [[nodiscard]] const std::vector<Rgb>& radiosity_of_nodes() const { return B_; }
  [[nodiscard]] std::vector<Rgb> irradiance_of_nodes() const;  ///< likewise

  [[nodiscard]] std::uint64_t links() const { return all_links_; }  ///< of all ranks
  [[nodiscard]] std::uint64_t bytes() const;                        ///< of this rank's links and of the tree
  [[nodiscard]] const RefinementCounts& counts() const { return counts_; }  ///< of this rank
  [[nodiscard]] std::uint64_t gather_rays() const { return gather_rays_; }  ///< of this rank

 private:
  struct Pass;
  /// Of leaves that are to be halved, what asks for each edge.
  using Votes = std::map<NodeId, std::array<std::uint64_t, 3>>;

  [[nodiscard]] std::vector<Rgb> gather_some(const Gatherer& gatherer, std::span<const GatherPoint> on_leaves,
                                             int bounces, std::uint64_t& parts);
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
  void grow(std::span<const Halving> wanted);
  void settle(std::vector<NodePair> open, RefinementGoal goal, std::uint64_t bytes, Progress& progress);
  void make_table();
  void take_radiosity(const std::function<Radiosity(RadiosityOperator&)>& find);
  [[nodiscard]] LinkedNodes linked_nodes() const;
  [[nodiscard]] std::vector<double> scale_rows(RadiosityOperator& F);
  [[nodiscard]] bool is_stopped() const;
  void handle_signals() const;
  void update_light(LinkOperator& F);
  void update_importance(RadiosityOperator& F);

  Ranks ranks_;
  const RayScene& ray_scene_;
  int threads_;
  OracleParts oracle_;
  std::function<void()> signal_handler_;
  NodeTree tree_;
  Refiner refiner_;
  LeafUnknowns leaves_;
  std::vector<GatherPoint> seen_;
  std::vector<NodeLight> light_;            // of all nodes
  std::vector<Rgb> B_;                      // likewise; none before the first solution
  std::vector<std::array<Rgb, 2>> slopes_;  // of the radiosity over each node that is a leaf
  double mean_ = 0;                         // of the light [W/m2]
  std::vector<Link> links_;                 // of this rank
  std::uint64_t all_links_ = 0;
  std::optional<LinkTable> table_;
  std::optional<Radiosity> radiosity_;
  RowSums row_sums_;
  std::vector<double> uncapped_sums_;  // empty where nothing was capped or closed
  std::optional<double> closure_tolerance_;
  std::optional<Closure> closure_;
  RefinementCounts counts_;
  std::uint64_t gather_rays_ = 0;
};

}  // namespace fluxel
