#include "hierarchy/ray_hierarchy.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/common.hpp>
#include <optional>
#include <utility>

#include "core/error.hpp"
#include "hierarchy/link_oracle.hpp"
#include "hierarchy/ray_gather.hpp"

namespace fluxel {

namespace {

/// Of the scene's area: what the nodes of the first cut have at most.
constexpr double kFirstShare = 1.0 / 512;

/// Of a goal: the error of one node's power, over that of the scene. By comparing stairs and halls.
constexpr double kGoal = 3e-3;

/// Two halves tell less of how light varies over a cluster than over a face.
constexpr double kOfClusters = 8;

/// In surface epsilons: smaller faces are points for rays.
constexpr double kMinLength = 32;

/// Of rows in a round: what is found too noisy to tell is not refined without end.
constexpr std::size_t kGrowth = 16;

constexpr std::size_t kRowsAtOnce = 8192;

/// What leaves reflect by their rows of the cut.
class LeavesOfCut final : public SolutionLight {
 public:
  LeavesOfCut(const NodeTree& tree, const CutLight& light) : tree_(tree), light_(light) {}
  [[nodiscard]] EndLight at(NodeId leaf, const glm::dvec3& /*point*/) const override {
    return {light_.reflected(leaf), tree_[leaf].shape.moments.trace()};
  }

 private:
  const NodeTree& tree_;
  CutLight light_;
};

}  // namespace

RayHierarchy::RayHierarchy(Ranks ranks, const Scene& scene, const RayScene& ray_scene, int threads,
                           const OracleParts& oracle)
    : Hierarchy(std::move(ranks), scene, ray_scene, threads, oracle),
      ray_light_(ray_scene, tree_, threads_, ranks_),
      rho_of_clusters_(tree_.clusters()) {
  for (std::size_t id = tree_.clusters(); id-- > 0;) {
    const auto [a, b] = tree_[static_cast<NodeId>(id)].child;
    const double share = tree_[b].shape.area / tree_[static_cast<NodeId>(id)].shape.area;
    rho_of_clusters_[id] = glm::vec3((1 - share) * reflectance(a) + share * reflectance(b));
  }
  Rgb sizes(0), rho(0);
  double area = 0;
  for (std::size_t id = tree_.clusters(); id < tree_.whole(); ++id) {
    const auto face = static_cast<NodeId>(id);
    const double A = tree_[face].shape.area;
    const Rgb E = tree_.emission(face);
    emission_ += A * E;
    sizes += A * glm::abs(E);  // of heat that is drawn too
    rho += A * tree_.material(face).rho;
    area += A;
  }
  if (area == 0) return;
  emission_ /= area;
  mean_ = first_mean((sizes + rho / area * ray_light_.luminaires().flux()) / area, rho / area);
}

std::uint64_t RayHierarchy::bytes() const {
  std::uint64_t sum = tree_.size() * sizeof(Node) +
                      (tree_.size() - tree_.whole()) * sizeof(Outline<glm::dvec3>) +
                      rows_.size() * sizeof(RayRow);
  for (const RayRow& row : rows_) sum += row.ends.capacity() * sizeof(RayEnd);
  return sum;
}

std::vector<NodeId> RayHierarchy::first_cut() const {
  std::vector<NodeId> cut, open;
  if (tree_.size() > 0) open.push_back(0);
  while (!open.empty()) {
    const NodeId id = open.back();
    open.pop_back();
    if (tree_.is_cluster(id) && tree_[id].shape.area > kFirstShare * tree_[0].shape.area) {
      open.push_back(tree_[id].child[0]);
      open.push_back(tree_[id].child[1]);
    } else {
      cut.push_back(id);
    }
  }
  return cut;
}

/// Rows of nodes that have none, each on the rank whose turn its number is.
void RayHierarchy::trace(std::span<const NodeId> nodes, Progress& progress) {
  std::vector<NodeId> own;
  for (const NodeId node : nodes)
    if (node % ranks_.size == ranks_.rank) own.push_back(node);
  const std::size_t before = rows_.size();
  rows_.resize(before + own.size());
  std::atomic<std::uint64_t> rays = 0;
  tbb::task_arena arena(threads_);
  for (std::size_t first = 0; first < own.size() && !is_stopped(); first += kRowsAtOnce) {
    const std::size_t last = std::min(own.size(), first + kRowsAtOnce);
    arena.execute([&] {
      tbb::parallel_for(first, last, [&](std::size_t k) {
        std::uint64_t of_row = 0;
        rows_[before + k] = trace_row(ray_light_, own[k], {}, of_row);
        rays += of_row;
      });
    });
    progress.update(static_cast<double>(last), static_cast<double>(own.size()), "of the rows of rays");
  }
  handle_signals();
  counts_.rays += rays;
}

/// Nodes of the cut whose light varies more than the goal allows; ascending, of all ranks.
std::vector<NodeId> RayHierarchy::wanted(double error, std::size_t first_row) const {
  const double allowed = tree_.size() > 0 ? kGoal * error * mean_ * tree_[0].shape.area : 0;
  const std::optional<CutLight> light = cut_light();
  std::vector<std::uint8_t> is_wanted(rows_.size());
  tbb::task_arena arena(threads_);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(first_row, rows_.size(), 64), [&](const auto& range) {
      std::vector<double> reflected;
      for (std::size_t k = range.begin(); k < range.end(); ++k) {
        const NodeId node = rows_[k].node;
        reflected.clear();
        for (const RayEnd& end : rows_[k].ends)
          reflected.push_back(light ? mean_of_colours(light->reflected(end.leaf)) : 0);
        const double rho =
            oracle_.heat ? 1.0 : std::max(kLeastReflectance, mean_of_colours(reflectance(node)));
        const double weight =
            importance_.empty() ? 1.0 : static_cast<double>(importance_[cut_.find_row(tree_, node)]);
        const double off = rho * deviation(tree_, rows_[k], reflected) * tree_[node].shape.area * weight *
                           weight * (tree_.is_cluster(node) ? kOfClusters : 1.0);
        const bool is_point =
            !tree_.is_cluster(node) && tree_.edge_length(node, edge_to_halve(tree_, node)) <
                                           kMinLength * static_cast<double>(ray_scene_.surface_epsilon());
        is_wanted[k] = off > allowed && !is_point ? 1 : 0;
      }
    });
  });
  std::vector<NodeId> own;
  for (std::size_t k = first_row; k < rows_.size(); ++k)
    if (is_wanted[k] != 0) own.push_back(rows_[k].node);
  std::vector<NodeId> all = ranks_.gather(std::span<const NodeId>(own));
  std::ranges::sort(all);
  return all;
}

/// Children take the places of these nodes of the cut.
void RayHierarchy::divide(std::span<const NodeId> nodes, Progress& progress) {
  std::vector<Halving> halvings;
  for (const NodeId node : nodes)
    if (tree_[node].is_leaf()) halvings.push_back({node, edge_to_halve(tree_, node)});
  tree_.split(halvings);
  const auto is_divided = [&](NodeId node) { return std::ranges::binary_search(nodes, node); };
  std::erase_if(nodes_, is_divided);
  std::erase_if(rows_, [&](const RayRow& row) { return is_divided(row.node); });
  std::vector<NodeId> children;
  for (const NodeId node : nodes)
    for (const NodeId child : tree_[node].child) children.push_back(child);
  nodes_.insert(nodes_.end(), children.begin(), children.end());
  trace(children, progress);
}

bool RayHierarchy::refine(double error, std::uint64_t bytes, Progress& progress) {
  if (nodes_.empty()) {
    nodes_ = first_cut();
    trace(nodes_, progress);
  }
  const std::size_t most = kGrowth * nodes_.size();
  bool fits = true;
  for (std::size_t first_row = 0; fits;) {
    const std::vector<NodeId> nodes = wanted(error, first_row);
    if (nodes.empty() || nodes_.size() + nodes.size() > most) break;
    // Each becomes two, of which a rank may have all.
    constexpr std::size_t kBytesPerRow = sizeof(RayRow) + 64 * sizeof(RayEnd);
    fits = !is_any(ranks_, this->bytes() + 2 * nodes.size() * kBytesPerRow > bytes || is_time_to_end());
    if (!fits) break;
    divide(nodes, progress);
    std::size_t own = 0;
    for (const NodeId node : nodes)
      for (const NodeId child : tree_[node].child) own += child % ranks_.size == ranks_.rank ? 1 : 0;
    first_row = rows_.size() - own;
  }
  order_rows();
  return fits;
}

void RayHierarchy::order_rows() {
  std::ranges::sort(rows_, {}, &RayRow::node);
  for (RayRow& row : rows_)
    for (RayEnd& end : row.ends) descend(tree_, end);
}

void RayHierarchy::take(Radiosity radiosity) {
  radiosity_ = std::move(radiosity);
  powers_.assign(cut_.nodes().size(), 0);
  Rgb power(0);
  for (std::size_t row = 0; row < powers_.size(); ++row) {
    const Rgb rho = reflectance(cut_.nodes()[row]);
    for (std::uint32_t k = cut_.first()[row]; k < cut_.first()[row + 1]; ++k) {
      const Rgb reflected = area_[k] * rho * radiosity_->B[k];
      power += reflected;
      powers_[row] += mean_of_colours(glm::abs(reflected));
    }
  }
  mean_radiosity_ = emission_ + power / tree_[0].shape.area;
  mean_ = mean_of_colours(mean_radiosity_);
}

void RayHierarchy::solve(Solver /*solver*/, const StopRule& stop, const IterationObserver& observer) {
  cut_ = TreeCut(tree_, nodes_, threads_);
  RayOperator F(tree_, cut_, rows_, ranks_, threads_);
  const Unknowns system = F.system();
  const RowSums sums = find_error_weights(F, system);
  Radiosity found = solve_radiosity(Solver::jacobi, {F, system, sums}, stop, observer);
  row_sums_ = F.row_sums();
  area_ = system.area;
  take(std::move(found));
  update_importance(F, system, sums);
}

std::optional<CutLight> RayHierarchy::cut_light() const {
  if (!radiosity_) return std::nullopt;
  return CutLight(tree_, cut_, radiosity_->B, powers_);
}

std::array<std::vector<Rgb>, 2> RayHierarchy::gather_halves(std::span<const GatherPoint> points,
                                                            const GatherGoal& goal, Progress& progress) {
  const LeavesOfCut light(tree_, *cut_light());
  RayGather rays(ray_light_, light, scale_);
  auto halves = rays.gather(points, goal,
                            {ranks_, threads_, [this] { return is_stopped(); }, [this] { handle_signals(); }},
                            progress);
  gather_rays_ += rays.rays();
  return halves;
}

std::vector<Rgb> RayHierarchy::gather(std::span<const GatherPoint> points, const GatherGoal& goal,
                                      Progress& progress) {
  return mean_of_halves(gather_halves(points, goal, progress));
}

LeafLight RayHierarchy::leaf_light() const {
  LeafLight light{LeafUnknowns(tree_), *radiosity_, {}, {}};
  const Unknowns& unknowns = light.leaves.unknowns();
  const CutLight of_cut = *cut_light();
  light.radiosity.B = unknowns.E;
  light.radiosity.H.assign(unknowns.size(), Rgb(0));
  light.row_sums.sums.resize(unknowns.size());
  tbb::task_arena arena(threads_);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, unknowns.size(), 1024), [&](const auto& range) {
      for (std::size_t k = range.begin(); k < range.end(); ++k) {
        const NodeId leaf = light.leaves.nodes()[k];
        if (leaf == kNoNode) continue;
        light.radiosity.H[k] = of_cut.irradiance(leaf);
        light.radiosity.B[k] += unknowns.rho[k] * light.radiosity.H[k];
        light.row_sums.sums[k] =
            cut_.part(cut_.row_of(tree_, leaf), tree_[leaf].shape.normal, std::span<const double>(row_sums_));
      }
    });
  });
  if (!light.row_sums.sums.empty()) light.row_sums.largest = *std::ranges::max_element(light.row_sums.sums);
  light.own_row_sums = light.row_sums.sums;
  return light;
}

/// Importance is what LinkHierarchy::update_importance says, on the cut: W = w + F rho W, of which w, what
/// points see of themselves, is gathered for each of them and does not count.
void RayHierarchy::update_importance(RayOperator& F, const Unknowns& system, const RowSums& sums) {
  importance_.clear();
  if (!asks_importance()) return;
  const std::unordered_map<NodeId, double> seen = seen_density();
  Unknowns adjoint = system;
  adjoint.E = F.reflected([&](NodeId leaf) {
    const auto found = seen.find(leaf);
    return found == seen.end() ? 0 : found->second;
  });
  const Radiosity sent = solve_radiosity(Solver::jacobi, {F, adjoint, sums}, {kImportanceTolerance, 100},
                                         [](const IterationState&) {});
  std::vector<double> of_nodes(cut_.nodes().size());
  double mean = 0;
  for (std::size_t row = 0; row < of_nodes.size(); ++row) {
    double area = 0;
    for (std::uint32_t k = cut_.first()[row]; k < cut_.first()[row + 1]; ++k) {
      of_nodes[row] += area_[k] * mean_of_colours(sent.B[k]);
      area += area_[k];
    }
    mean += of_nodes[row] / tree_[0].shape.area;
    if (area > 0) of_nodes[row] /= area;
  }
  for (const double importance : of_nodes) importance_.push_back(weight_of(importance, mean));
}

void RayHierarchy::look_again() {
  RayOperator F(tree_, cut_, rows_, ranks_, threads_);
  const Unknowns system = F.system();
  update_importance(F, system, find_error_weights(F, system));
}

void RayHierarchy::restore(KeptRounds kept, std::vector<Link> /*links*/, const RefinementCounts& counts) {
  const auto refuse = [] {
    throw InputError("the kept rounds do not fit the scene's tree: remove them, and begin anew");
  };
  if (!tree_.halve_again(kept.halvings) || tree_.size() != kept.rounds.back().nodes) refuse();
  nodes_ = std::move(kept.cut);
  if (std::ranges::any_of(nodes_, [&](NodeId id) { return id >= tree_.size(); })) refuse();
  cut_ = TreeCut(tree_, nodes_, threads_);
  for (std::size_t id = tree_.clusters(); id < tree_.size(); ++id)
    if (const auto face = static_cast<NodeId>(id);
        tree_[face].is_leaf() && cut_.row_of(tree_, face) == TreeCut::kNoRow)
      refuse();
  for (std::size_t k = 0; k < cut_.nodes().size(); ++k) {
    const NodeId parent = tree_[cut_.nodes()[k]].parent;
    const bool lies_below = parent != kNoNode && cut_.find_row(tree_, parent) != TreeCut::kNoRow;
    if (lies_below || (k > 0 && cut_.nodes()[k] == cut_.nodes()[k - 1])) refuse();
  }
  if (kept.radiosity.B.size() != cut_.unknowns()) refuse();
  SilentProgress silent;
  trace(nodes_, silent);
  counts_ = counts;
  order_rows();
  {
    const RayOperator F(tree_, cut_, rows_, ranks_, threads_);
    row_sums_ = F.row_sums();
    area_ = F.system().area;
  }
  take(std::move(kept.radiosity));
  look_again();
}

}  // namespace fluxel
