#include "hierarchy/hierarchy.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

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
      tree_(scene, threads, ranks_) {}

double Hierarchy::first_mean(const Rgb& emitted, const Rgb& rho) {
  return mean_of_colours(emitted) / (1 - std::min(0.9, mean_of_colours(rho)));
}

void Hierarchy::set_importance_points(std::vector<GatherPoint> seen) { seen_ = std::move(seen); }

namespace {

std::vector<Rgb> of_nodes(const NodeTree& tree, std::span<const NodeId> leaves, std::span<const Rgb> values) {
  std::vector<Rgb> nodes(tree.size());
  for (std::size_t k = 0; k < values.size(); ++k)
    if (leaves[k] != kNoNode) nodes[leaves[k]] = values[k];
  pull(tree, std::span(nodes));
  return nodes;
}

}  // namespace

std::vector<Rgb> Hierarchy::radiosity_of_nodes() const {
  const LeafLight light = leaf_light();
  return of_nodes(tree_, light.leaves.nodes(), light.radiosity.B);
}

std::vector<Rgb> Hierarchy::irradiance_of_nodes() const {
  const LeafLight light = leaf_light();
  return of_nodes(tree_, light.leaves.nodes(), light.radiosity.H);
}

std::unordered_map<NodeId, double> Hierarchy::seen_density() const {
  std::unordered_map<NodeId, double> seen;
  for (const GatherPoint& point : seen_)
    if (const NodeId id = tree_.leaf_below(point.face, point.position); id != kNoNode) seen[id] += 1;
  for (auto& [id, density] : seen)
    density *= tree_[0].shape.area / (tree_[id].shape.area * static_cast<double>(seen_.size()));
  return seen;
}

float Hierarchy::weight_of(double importance, double mean) {
  return static_cast<float>(std::sqrt(std::max(kMinImportance, importance / mean)));
}

}  // namespace fluxel
