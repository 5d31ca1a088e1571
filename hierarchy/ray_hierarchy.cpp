#include "hierarchy/ray_hierarchy.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "core/error.hpp"
#include "hierarchy/link_oracle.hpp"

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

}  // namespace

RayHierarchy::RayHierarchy(Ranks ranks, const Scene& scene, const RayScene& ray_scene, int threads,
                           const OracleParts& oracle)
    : Hierarchy(std::move(ranks), scene, ray_scene, threads, oracle), ray_light_(ray_scene, tree_) {
  tree_.forget_shares();
}

std::uint64_t RayHierarchy::bytes() const {
  constexpr std::uint64_t kBytesPerNode =
      sizeof(Node) + sizeof(Outline<glm::dvec3>) + sizeof(NodeLight) + 8 * sizeof(Rgb);
  std::uint64_t sum = tree_.size() * kBytesPerNode + rows_.size() * sizeof(RayRow);
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
  std::vector<double> reflected(tree_.size());
  for (std::size_t id = 0; id < tree_.size(); ++id) {
    const auto node = static_cast<NodeId>(id);
    if (B_.empty() || tree_.is_cluster(node)) continue;
    reflected[id] = mean_of_colours(B_[id] - tree_.emission(node));
  }
  const double allowed = tree_.size() > 0 ? kGoal * error * mean_ * tree_[0].shape.area : 0;
  std::vector<std::uint8_t> is_wanted(rows_.size());
  tbb::task_arena arena(threads_);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(first_row, rows_.size(), 64), [&](const auto& range) {
      for (std::size_t k = range.begin(); k < range.end(); ++k) {
        const NodeId node = rows_[k].node;
        const NodeLight& light = light_[node];
        const double rho = oracle_.heat ? 1.0 : std::max(kLeastReflectance, static_cast<double>(light.rho));
        const double importance =
            static_cast<double>(light.importance) * static_cast<double>(light.importance);
        const double off = rho * deviation(tree_, rows_[k], reflected) * tree_[node].shape.area * importance *
                           (tree_.is_cluster(node) ? kOfClusters : 1.0);
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
  grow(halvings);
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
  leaves_ = LeafUnknowns(tree_);
  cut_ = TreeCut(tree_, leaves_, nodes_);
}

void RayHierarchy::solve(Solver /*solver*/, const StopRule& stop, const IterationObserver& observer) {
  const Unknowns& unknowns = leaves_.unknowns();
  RayOperator F(tree_, leaves_, cut_, rows_, ranks_, threads_);
  std::vector<Rgb> start = radiosity_of_leaves();
  for (std::size_t k = 0; k < start.size(); ++k) start[k] -= unknowns.E[k];
  radiosity_.reset();  // the most memory is needed here
  // What is emitted is a source, and what it leads to the unknown.
  Unknowns reflected = unknowns;
  reflected.E = F.emitted();
  for (std::size_t k = 0; k < reflected.size(); ++k) reflected.E[k] *= unknowns.rho[k];
  row_sums_ = find_error_weights(F, reflected);
  Radiosity found = solve_radiosity(Solver::jacobi, {F, reflected, row_sums_}, stop, observer, start);
  const std::vector<Rgb> by_emission = F.emitted();
  for (std::size_t k = 0; k < found.B.size(); ++k) {
    found.B[k] += unknowns.E[k];
    found.H[k] += by_emission[k];
  }
  take(std::move(found));
  update_light(F);
}

void RayHierarchy::update_light(RayOperator& F) {
  light_ = light_of_nodes(tree_, leaves_, radiosity_->B, {});
  if (!oracle_.power) forget_power(mean_, light_);
  // What points see of themselves is gathered for each of them.
  update_importance(F, 0);
}

void RayHierarchy::look_again() {
  RayOperator F(tree_, leaves_, cut_, rows_, ranks_, threads_);
  update_light(F);
}

void RayHierarchy::restore(KeptRounds kept, std::vector<Link> /*links*/, const RefinementCounts& counts) {
  const auto refuse = [] {
    throw InputError("the kept rounds do not fit the scene's tree: remove them, and begin anew");
  };
  const bool halved = tree_.halve_again(kept.halvings) && tree_.size() == kept.rounds.back().nodes;
  if (!halved || kept.radiosity.B.size() != LeafUnknowns(tree_).unknowns().size()) refuse();
  nodes_ = std::move(kept.cut);
  if (std::ranges::any_of(nodes_, [&](NodeId id) { return id >= tree_.size(); })) refuse();
  SilentProgress silent;
  trace(nodes_, silent);
  counts_ = counts;
  order_rows();
  for (std::size_t k = 0; k < cut_.of_leaf.size(); ++k)
    if (leaves_.nodes()[k] != kNoNode && cut_.of_leaf[k] == kNoNode) refuse();
  RayOperator F(tree_, leaves_, cut_, rows_, ranks_, threads_);
  row_sums_ = find_error_weights(F, leaves_.unknowns());
  take(std::move(kept.radiosity));
  update_light(F);
}

}  // namespace fluxel
