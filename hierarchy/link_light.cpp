// The light of nodes between rounds of LinkHierarchy.

#include <utility>

#include "core/reserve_more.hpp"
#include "hierarchy/link_hierarchy.hpp"

namespace fluxel {

std::vector<Rgb> LinkHierarchy::radiosity_of_leaves() const {
  std::vector<Rgb> B;
  if (B_.empty()) return B;
  B.resize(leaves_.nodes().size());
  for (std::size_t k = 0; k < B.size(); ++k)
    if (const NodeId id = leaves_.nodes()[k]; id != kNoNode) B[k] = B_[id];
  return B;
}

void LinkHierarchy::take(Radiosity radiosity) {
  radiosity_ = std::move(radiosity);
  B_.assign(tree_.size(), Rgb(0));
  for (std::size_t k = 0; k < radiosity_->B.size(); ++k)
    if (const NodeId id = leaves_.nodes()[k]; id != kNoNode) B_[id] = radiosity_->B[k];
  pull(tree_, std::span(B_));
  mean_ = mean_of_colours(mean_radiosity());
}

void LinkHierarchy::grow(std::span<const Halving> wanted) {
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

/// What an error at an unknown does to what is seen is the solution of the transposed system, which with A F
/// symmetric is W = w + F rho W: with Y = rho W a radiosity again.
void LinkHierarchy::update_importance(RadiosityOperator& F) {
  if (!asks_importance()) return;
  const std::unordered_map<NodeId, double> seen = seen_density();
  const auto seen_of = [&](NodeId id) {
    const auto found = seen.find(id);
    return found == seen.end() ? 0 : found->second;
  };
  Unknowns adjoint = leaves_.unknowns();
  adjoint.H0.clear();
  for (std::size_t k = 0; k < adjoint.size(); ++k) {
    adjoint.rho[k] = Rgb(mean_of_colours(adjoint.rho[k]));
    adjoint.E[k] = adjoint.rho[k] * seen_of(leaves_.nodes()[k]);
  }
  const Radiosity sent = solve_radiosity(radiosity_->solver, {F, adjoint, row_sums_},
                                         {kImportanceTolerance, 100}, [](const IterationState&) {});
  std::vector<double> importance(tree_.size());
  for (std::size_t k = 0; k < adjoint.size(); ++k)
    if (const NodeId id = leaves_.nodes()[k]; id != kNoNode) importance[id] = sent.H[k].r + seen_of(id);
  pull(tree_, std::span(importance));
  for (std::size_t id = 0; id < tree_.size(); ++id)
    light_[id].importance = weight_of(importance[id], importance[0]);
}

}  // namespace fluxel
