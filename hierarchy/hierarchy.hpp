#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/progress.hpp"
#include "core/ranks.hpp"
#include "hierarchy/cut_light.hpp"
#include "hierarchy/gather.hpp"
#include "hierarchy/irradiance_source.hpp"
#include "hierarchy/kept_rounds.hpp"
#include "hierarchy/link.hpp"
#include "hierarchy/node_light.hpp"
#include "hierarchy/node_tree.hpp"
#include "hierarchy/refinement.hpp"
#include "solver/closure.hpp"
#include "solver/iterate.hpp"

namespace fluxel {

/// What decides how fine the exchange between nodes is, beside its geometry.
struct OracleParts {
  bool power = true;       ///< the radiosity that is sent
  bool importance = true;  ///< what can be seen of an error
  bool heat = false;       ///< see RefinementGoal
};

/// Light of all leaves, as the last solution has it.
struct LeafLight {
  LeafUnknowns leaves;
  Radiosity radiosity;               ///< an entry an unknown
  RowSums row_sums;                  ///< likewise
  std::vector<double> own_row_sums;  ///< of the exchange as it is: row_sums may be capped or closed
};

/// Radiosity on a tree of nodes, refined and solved in turn; how nodes exchange light is what LinkHierarchy
/// and RayHierarchy have each in their way. The tree and the light are the same on all ranks, byte for byte
/// and for every number of them. All calls are collective, but for those that only look at a solution.
class Hierarchy : public IrradianceSource {
 public:
  /// The scene and the ray scene must outlive this.
  Hierarchy(Ranks ranks, const Scene& scene, const RayScene& ray_scene, int threads,
            const OracleParts& oracle);

  /// Points at whose radiosity an error matters, of any nodes that are faces, in place of those before;
  /// without any it matters everywhere alike.
  void set_importance_points(std::vector<GatherPoint> seen);

  /// What a rank asks between parts of refine, by itself: where it is true on any of them, refine ends early.
  void end_refinement_when(std::function<bool()> is_time) { is_time_to_end_ = std::move(is_time); }

  /// For scenes that let no light out: in solves the row sums are made 1 where what they miss would cost more
  /// than this of the radiosity.
  void close_rows(double tolerance) { closure_tolerance_ = tolerance; }
  /// How the row sums of the last solve were made 1, where that was needed.
  [[nodiscard]] const std::optional<Closure>& closure() const { return closure_; }

  /// Looks at the radiosity that there is again, after importance points have been set or row sums are to be
  /// closed: what the next refinement goes by.
  virtual void look_again() = 0;

  /// Takes up what a hierarchy of the same scene and points has come to, in place of the first refinement
  /// and solve. `links`, between the nodes that there were, are those of this rank, whoever had them.
  /// Throws InputError, on all ranks alike, where the tree is another.
  virtual void restore(KeptRounds kept, std::vector<Link> links, const RefinementCounts& counts) = 0;

  /// Divides nodes, and what they exchange light by, until what each leaves is at most `error` (see
  /// RefinementGoal). Ends early, and says so by false, where a rank would take more than `bytes`: all is
  /// then about as fine as that allows; and when it is asked to end: then what is open stays as coarse as it
  /// is.
  [[nodiscard]] virtual bool refine(double error, std::uint64_t bytes, Progress& progress) = 0;

  /// The radiosity by the exchange that there is.
  virtual void solve(Solver solver, const StopRule& stop, const IterationObserver& observer) = 0;

  /// What gathering takes of reflected light from the solution is multiplied by this from now on, and what
  /// emitters send is not.
  void scale_reflected(const Rgb& scale) { scale_ = scale; }

  /// Of this rank.
  [[nodiscard]] virtual std::span<const Link> own_links() const { return {}; }
  [[nodiscard]] virtual std::uint64_t links() const { return 0; }  ///< of all ranks
  /// Nodes that rows of rays are of; none where there are links.
  [[nodiscard]] virtual std::span<const NodeId> cut() const { return {}; }
  /// On that cut, by the last solution; none where there are links.
  [[nodiscard]] virtual std::optional<CutLight> cut_light() const { return std::nullopt; }
  /// Of a target for the error of a picture: what the rays that gather it may have, so that the whole takes
  /// the least time.
  [[nodiscard]] virtual double share_of_rays() const { return 0.4; }
  /// Of this rank: what the exchange and the tree take.
  [[nodiscard]] virtual std::uint64_t bytes() const = 0;

  [[nodiscard]] const NodeTree& tree() const override { return tree_; }
  /// The last solution, of what the exchange has as unknowns: leaves, or the irradiance of a cut.
  [[nodiscard]] const Radiosity& radiosity() const { return *radiosity_; }
  /// Made anew, in a pass over all leaves.
  [[nodiscard]] virtual LeafLight leaf_light() const = 0;
  [[nodiscard]] std::vector<Rgb> radiosity_of_nodes() const;   ///< likewise: the mean over each node [W/m2]
  [[nodiscard]] std::vector<Rgb> irradiance_of_nodes() const;  ///< likewise

  [[nodiscard]] const RefinementCounts& counts() const { return counts_; }  ///< of this rank
  [[nodiscard]] std::uint64_t gather_rays() const override { return gather_rays_; }

 protected:
  [[nodiscard]] bool is_time_to_end() const { return is_time_to_end_ && is_time_to_end_(); }  ///< this rank's
  /// Of light, before there is a solution: all that is emitted, in size, is taken to be spread evenly. From
  /// means over all surfaces.
  [[nodiscard]] static double first_mean(const Rgb& emitted, const Rgb& rho);
  /// What of the importance points lies on leaves, over the mean of all surfaces; elsewhere there are none.
  [[nodiscard]] std::unordered_map<NodeId, double> seen_density() const;
  [[nodiscard]] bool asks_importance() const { return oracle_.importance && !seen_.empty(); }
  /// What errors count where the importance is this and its mean that.
  [[nodiscard]] static float weight_of(double importance, double mean);

  /// Of max |B - B*| over the area-mean: of importance, which only weighs.
  static constexpr double kImportanceTolerance = 0.03;

  Ranks ranks_;
  const RayScene& ray_scene_;
  int threads_;
  OracleParts oracle_;
  NodeTree tree_;
  double mean_ = 0;  // of the light [W/m2]
  std::optional<Radiosity> radiosity_;
  std::optional<double> closure_tolerance_;
  std::optional<Closure> closure_;
  RefinementCounts counts_;
  std::uint64_t gather_rays_ = 0;
  Rgb scale_{1};  // of reflected light that is gathered

 private:
  std::function<bool()> is_time_to_end_;
  std::vector<GatherPoint> seen_;
};

}  // namespace fluxel
