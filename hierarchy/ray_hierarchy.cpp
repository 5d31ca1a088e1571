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
        const double off = rho * deviation(tree_, rows_[k], B_) * tree_[node].shape.area * importance *
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
  cut_ = TreeCut(tree_, nodes_);
}

void RayHierarchy::solve(Solver /*solver*/, const StopRule& stop, const IterationObserver& observer) {
  RayOperator F(tree_, cut_, rows_, ranks_, threads_);
  const Unknowns system = F.system();
  const RowSums of_cut = find_error_weights(F, system);
  Radiosity found = solve_radiosity(Solver::jacobi, {F, system, of_cut}, stop, observer);
  const Unknowns& unknowns = leaves_.unknowns();
  const std::vector<Rgb> H = std::exchange(found.B, {});
  found.B = unknowns.E;
  found.H.assign(unknowns.size(), Rgb(0));
  for (std::size_t k = 0; k < unknowns.size(); ++k) {
    const NodeId leaf = leaves_.nodes()[k];
    if (leaf == kNoNode) continue;
    found.H[k] = cut_.part(cut_.of_node[leaf], tree_[leaf].shape.normal, std::span<const Rgb>(H));
    found.B[k] += unknowns.rho[k] * found.H[k];
  }
  take(std::move(found));
  row_sums_ = sums_of_leaves(F);
  update_importance_on_cut(F, of_cut);
}

/// Of F alone, for all leaves.
RowSums RayHierarchy::sums_of_leaves(const RayOperator& F) const {
  const std::vector<double> of_cut = F.row_sums();
  RowSums found;
  found.sums.resize(leaves_.nodes().size());
  for (std::size_t k = 0; k < found.sums.size(); ++k) {
    const NodeId leaf = leaves_.nodes()[k];
    if (leaf == kNoNode) continue;
    found.sums[k] = cut_.part(cut_.of_node[leaf], tree_[leaf].shape.normal, std::span<const double>(of_cut));
    found.largest = std::max(found.largest, found.sums[k]);
  }
  return found;
}

/// Importance is what Hierarchy::update_importance says, on the cut: W = w + F rho W, of which w, what points
/// see of themselves, is gathered for each of them and does not count.
void RayHierarchy::update_importance_on_cut(RayOperator& F, const RowSums& of_cut) {
  if (!asks_importance()) return;
  Unknowns adjoint = F.system();
  adjoint.E = F.reflected(seen_density());
  const Radiosity sent = solve_radiosity(Solver::jacobi, {F, adjoint, of_cut}, {kImportanceTolerance, 100},
                                         [](const IterationState&) {});
  std::vector<double> importance(tree_.size());
  for (const NodeId leaf : leaves_.nodes())
    if (leaf != kNoNode)
      importance[leaf] = mean_of_colours(
          cut_.part(cut_.of_node[leaf], tree_[leaf].shape.normal, std::span<const Rgb>(sent.B)));
  set_importance(std::move(importance));
}

void RayHierarchy::look_again() {
  RayOperator F(tree_, cut_, rows_, ranks_, threads_);
  update_importance_on_cut(F, find_error_weights(F, F.system()));
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
  for (const NodeId leaf : leaves_.nodes())
    if (leaf != kNoNode && cut_.of_node[leaf] == kNoNode) refuse();
  const RayOperator F(tree_, cut_, rows_, ranks_, threads_);
  row_sums_ = sums_of_leaves(F);
  take(std::move(kept.radiosity));
  light_ = light_of_nodes(tree_, leaves_, radiosity_->B, {});
  look_again();
}

}  // namespace fluxel
