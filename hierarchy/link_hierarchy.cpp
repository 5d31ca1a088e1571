#include "hierarchy/link_hierarchy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "core/error.hpp"
#include "core/signals.hpp"
#include "hierarchy/cluster_shares.hpp"
#include "solver/choose_solver.hpp"
#include "solver/scaled_operator.hpp"

namespace fluxel {

namespace {

/// Of the operator: what whole units of contributions lose.
constexpr double kLinkRounding = 0x1p-40;

/// Of w = 1 + rho F w, before row sums are capped.
constexpr int kMaxSweeps = 30;

/// What row sums, which are 1 at most, are capped at: of coarse links some are far too large, and many more
/// a little, as others are too small. To cut all of them off would make scenes darker, so lower limits are
/// for light that could grow.
constexpr std::array kRowLimits{1.2, 1.1, 1.05, 1.0};

/// Of closed scenes, whose row sums are to be 1.
constexpr ClosureGoal kClosureGoal{1e-3, 30};

}  // namespace

LinkHierarchy::LinkHierarchy(Ranks ranks, const Scene& scene, const RayScene& ray_scene, int threads,
                             const OracleParts& oracle)
    : Hierarchy(std::move(ranks), scene, ray_scene, threads, oracle),
      refiner_(ray_scene, tree_),
      luminaires_(ray_scene),
      first_light_(luminaires_, tree_),
      leaves_(tree_) {
  find_first_light();
  std::vector<Rgb> sizes = sources(leaves_.unknowns());
  std::vector<std::array<Rgb, 2>> slopes(sizes.size(), {Rgb(0), Rgb(0)});
  take_light(sizes, slopes);
  for (Rgb& E : sizes) E = glm::abs(E);  // of heat that is drawn too
  mean_ =
      first_mean(area_mean(leaves_.unknowns(), sizes), area_mean(leaves_.unknowns(), leaves_.unknowns().rho));
  if (!oracle_.power) forget_power(mean_, light_);
  share_out();
}

/// Ranks take turns with the faces.
void LinkHierarchy::share_out() {
  std::vector<NodeId> faces;
  for (std::size_t id = tree_.clusters() + ranks_.rank; id < tree_.whole(); id += ranks_.size)
    faces.push_back(static_cast<NodeId>(id));
  std::vector<std::uint64_t> sums = light_out(ray_scene_, tree_, faces, threads_);
  ranks_.sum(std::span(sums));
  tree_.set_shares(cluster_shares(tree_, sums));
}

void LinkHierarchy::restore(KeptRounds kept, std::vector<Link> links, const RefinementCounts& counts) {
  const bool halved = tree_.halve_again(kept.halvings) && tree_.size() == kept.rounds.back().nodes;
  if (!halved || kept.radiosity.B.size() != LeafUnknowns(tree_).unknowns().size())
    throw InputError("the kept rounds do not fit the scene's tree: remove them, and begin anew");
  links_ = std::move(links);
  counts_ = counts;
  make_table();
  take_radiosity([&kept](RadiosityOperator&) { return std::move(kept.radiosity); });
}

void LinkHierarchy::look_again() {
  take_radiosity([this](RadiosityOperator&) { return *radiosity_; });
}

void LinkHierarchy::solve(Solver solver, const StopRule& stop, const IterationObserver& observer) {
  const Unknowns& unknowns = leaves_.unknowns();
  const std::vector<Rgb> start = radiosity_of_leaves();
  take_radiosity([&](RadiosityOperator& F) {
    if (solver == Solver::automatic) solver = choose_solver(row_sums_).solver;
    return solve_radiosity(solver, {F, unknowns, row_sums_}, stop, observer, start);
  });
}

/// A diagonal D for D F D, with the row sums and the weights of that; empty where F is good as it is.
std::vector<double> LinkHierarchy::scale_rows(RadiosityOperator& F) {
  const Unknowns& unknowns = leaves_.unknowns();
  row_sums_ = find_error_weights(F, unknowns, kLinkRounding, kMaxSweeps);
  uncapped_sums_.clear();
  closure_.reset();
  std::vector<double> scale;
  const auto take = [&](std::vector<double> by) {
    if (uncapped_sums_.empty()) uncapped_sums_ = row_sums_.sums;
    scale = std::move(by);
    ScaledOperator scaled(F, scale);
    row_sums_ = find_error_weights(scaled, unknowns, kLinkRounding);
  };
  if (closure_tolerance_ && !B_.empty()) {
    // What has not been lit is apart from the rest, as the outside of a room is.
    std::vector<double> wanted(row_sums_.sums.size());
    for (std::size_t k = 0; k < wanted.size(); ++k)
      if (const NodeId id = leaves_.nodes()[k]; id != kNoNode && row_sums_.sums[k] > 0)
        wanted[k] = B_[id] != Rgb(0) ? 1.0 : 0.0;
    if (cost_of_defect(F.ranks(), unknowns, row_sums_.sums, wanted) > *closure_tolerance_) {
      closure_ = find_closure(F, wanted, kClosureGoal);
      take(closure_->scale);
    }
  }
  // Coarse links may send more to a node than there is: then no light could be bounded.
  if (row_sums_.weights && row_sums_.largest <= kRowLimits.front()) return scale;
  const std::vector<double> sums = row_sums_.sums;
  const std::vector<double> closed = scale;
  for (const double limit : kRowLimits) {
    std::vector<double> capped = cap_row_sums(sums, limit);
    // What reflects nothing sends nothing on, however much it gets, and a lamp is not to be dimmed for it.
    for (std::size_t k = 0; k < capped.size(); ++k)
      if (unknowns.rho[k] == Rgb(0)) capped[k] = 1;
    for (std::size_t k = 0; k < closed.size(); ++k) capped[k] *= closed[k];
    take(std::move(capped));
    if (row_sums_.weights) break;
  }
  return scale;
}

/// By the links of all ranks.
LinkedNodes LinkHierarchy::linked_nodes() const {
  std::vector<std::uint64_t> has_links(tree_.size());
  for (std::size_t id = 0; id < tree_.size(); ++id)
    has_links[id] = table_->of(static_cast<NodeId>(id)).size();
  ranks_.sum(std::span(has_links));
  return {tree_, leaves_, has_links};
}

/// What `find` makes of the links that there are, and what that says of the nodes.
void LinkHierarchy::take_radiosity(const std::function<Radiosity(RadiosityOperator&)>& find) {
  const LinkedNodes linked = linked_nodes();
  LinkOperator F(linked, *table_, ranks_.sum, threads_);
  const std::vector<double> scale = scale_rows(F);
  std::optional<ScaledOperator> scaled;
  if (!scale.empty()) scaled.emplace(F, scale);
  RadiosityOperator& safe = scaled ? static_cast<RadiosityOperator&>(*scaled) : F;
  take(find(safe));
  update_light(F);
  update_importance(safe);
}

}  // namespace fluxel
