#include "hierarchy/hierarchy.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "core/reserve_more.hpp"
#include "core/signals.hpp"

namespace fluxel {

namespace {

/// Errors where nothing is seen count this much of the mean.
constexpr double kMinImportance = 0.03;

}  // namespace

Hierarchy::Hierarchy(Ranks ranks, const Scene& scene, const RayScene& ray_scene, int threads,
                     const OracleParts& oracle)
    : ranks_(std::move(ranks)),
      ray_scene_(ray_scene),
      threads_(threads),
      oracle_(oracle),
      tree_(scene, threads),
      leaves_(tree_) {
  const Unknowns& unknowns = leaves_.unknowns();
  light_ = light_of_nodes(tree_, leaves_, unknowns.E, {});
  // Before there is a solution all that is emitted is taken to be spread evenly.
  std::vector<Rgb> sizes = unknowns.E;
  for (Rgb& E : sizes) E = glm::abs(E);  // of heat that is drawn too
  const double E = mean_of_colours(area_mean(unknowns, sizes));
  mean_ = E / (1 - std::min(0.9, mean_of_colours(area_mean(unknowns, unknowns.rho))));
  if (!oracle_.power) forget_power(mean_, light_);
}

void Hierarchy::set_importance_points(std::vector<GatherPoint> seen) { seen_ = std::move(seen); }

bool Hierarchy::is_stopped() const { return signal_handler_ && stop_requested(); }

void Hierarchy::handle_signals() const {
  if (signal_handler_) signal_handler_();
}

std::vector<Rgb> Hierarchy::radiosity_of_leaves() const {
  std::vector<Rgb> B;
  if (B_.empty()) return B;
  B.resize(leaves_.nodes().size());
  for (std::size_t k = 0; k < B.size(); ++k)
    if (const NodeId id = leaves_.nodes()[k]; id != kNoNode) B[k] = B_[id];
  return B;
}

void Hierarchy::take(Radiosity radiosity) {
  radiosity_ = std::move(radiosity);
  B_.assign(tree_.size(), Rgb(0));
  for (std::size_t k = 0; k < radiosity_->B.size(); ++k)
    if (const NodeId id = leaves_.nodes()[k]; id != kNoNode) B_[id] = radiosity_->B[k];
  pull(tree_, std::span(B_));
  mean_ = mean_of_colours(mean_radiosity());
}

void Hierarchy::grow(std::span<const Halving> wanted) {
  const std::size_t before = tree_.size();
  tree_.split(wanted);
  reserve_more(light_, tree_.size() - before);
  if (!B_.empty()) reserve_more(B_, tree_.size() - before);
  for (std::size_t id = before; id < tree_.size(); ++id) {
    const NodeId parent = tree_[static_cast<NodeId>(id)].parent;
    NodeLight light = light_[parent];
    light.deviation /= 2;
    light_.push_back(light);
    if (!B_.empty()) B_.push_back(B_[parent]);
  }
}

std::vector<Rgb> Hierarchy::irradiance_of_nodes() const {
  std::vector<Rgb> H(tree_.size());
  for (std::size_t k = 0; k < radiosity_->H.size(); ++k)
    if (const NodeId id = leaves_.nodes()[k]; id != kNoNode) H[id] = radiosity_->H[k];
  pull(tree_, std::span(H));
  return H;
}

std::vector<double> Hierarchy::seen_density() const {
  std::vector<double> seen(tree_.size());
  for (const GatherPoint& point : seen_)
    if (const NodeId id = tree_.leaf_below(point.face, point.position); id != kNoNode) seen[id] += 1;
  double whole = 0;
  for (const double area : leaves_.unknowns().area) whole += area;
  for (std::size_t id = 0; id < seen.size(); ++id)
    if (seen[id] > 0)
      seen[id] *= whole / (tree_[static_cast<NodeId>(id)].shape.area * static_cast<double>(seen_.size()));
  return seen;
}

void Hierarchy::set_importance(std::vector<double> importance) {
  pull(tree_, std::span(importance));
  const double mean = importance.empty() ? 1 : importance[0];
  for (std::size_t id = 0; id < tree_.size(); ++id)
    light_[id].importance = static_cast<float>(std::sqrt(std::max(kMinImportance, importance[id] / mean)));
}

/// What an error at an unknown does to what is seen is the solution of the transposed system, which with A F
/// symmetric is W = w + F rho W: with Y = rho W a radiosity again.
void Hierarchy::update_importance(RadiosityOperator& F, double of_points) {
  if (!asks_importance()) return;
  const std::vector<double> seen = seen_density();
  Unknowns adjoint = leaves_.unknowns();
  for (std::size_t k = 0; k < adjoint.size(); ++k) {
    const NodeId id = leaves_.nodes()[k];
    adjoint.rho[k] = Rgb(mean_of_colours(adjoint.rho[k]));
    adjoint.E[k] = adjoint.rho[k] * (id == kNoNode ? 0 : seen[id]);
  }
  const Radiosity sent = solve_radiosity(radiosity_->solver, {F, adjoint, row_sums_},
                                         {kImportanceTolerance, 100}, [](const IterationState&) {});
  std::vector<double> importance(tree_.size());
  for (std::size_t k = 0; k < adjoint.size(); ++k)
    if (const NodeId id = leaves_.nodes()[k]; id != kNoNode)
      importance[id] = sent.H[k].r + of_points * seen[id];
  set_importance(std::move(importance));
}

}  // namespace fluxel
