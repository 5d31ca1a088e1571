#include "hierarchy/hierarchy.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "core/error.hpp"
#include "core/signals.hpp"
#include "hierarchy/cluster_shares.hpp"
#include "solver/choose_solver.hpp"
#include "solver/closure.hpp"
#include "solver/scaled_operator.hpp"

namespace fluxel {

namespace {

/// Nodes between all pairs of which refinement begins, so that there is something to share.
constexpr std::size_t kFirstNodes = 128;

/// Of the operator: what whole units of contributions lose.
constexpr double kBlockRounding = 0x1p-40;

/// Of w = 1 + rho F w, before row sums are capped.
constexpr int kMostSweeps = 30;

/// What row sums, which are 1 at most, are capped at: of coarse blocks some are far too large, and many more
/// a little, as others are too small. To cut all of them off would make scenes darker, so lower limits are
/// for light that could grow.
constexpr std::array kRowLimits{1.2, 1.1, 1.05, 1.0};

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

template <class T>
void sort_unique(std::vector<T>& items) {
  std::ranges::sort(items);
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

}  // namespace

Hierarchy::Hierarchy(Ranks ranks, const Scene& scene, const RayScene& ray_scene, int threads,
                     const OracleParts& oracle)
    : ranks_(std::move(ranks)),
      ray_scene_(ray_scene),
      threads_(threads),
      oracle_(oracle),
      tree_(scene),
      refiner_(ray_scene, tree_),
      leaves_(tree_) {
  share_out();
  const Unknowns& unknowns = leaves_.unknowns();
  light_ = light_of_nodes(tree_, leaves_, unknowns.E, {});
  // Before there is a solution all that is emitted is taken to be spread evenly.
  std::vector<Rgb> sizes = unknowns.E;
  for (Rgb& E : sizes) E = glm::abs(E);  // of heat that is drawn too
  const double E = mean_of_colours(area_mean(unknowns, sizes));
  mean_ = E / (1 - std::min(0.9, mean_of_colours(area_mean(unknowns, unknowns.rho))));
  if (!oracle_.power) forget_power(mean_, light_);
}

/// Ranks take turns with the faces.
void Hierarchy::share_out() {
  std::vector<NodeId> faces;
  for (std::size_t id = tree_.clusters() + ranks_.rank; id < tree_.whole(); id += ranks_.size)
    faces.push_back(static_cast<NodeId>(id));
  std::vector<std::uint64_t> sums = light_out(ray_scene_, tree_, faces, threads_);
  ranks_.sum(std::span(sums));
  tree_.set_shares(cluster_shares(tree_, sums));
}

void Hierarchy::look_at_points(std::vector<GatherPoint> seen) { seen_ = std::move(seen); }

std::uint64_t Hierarchy::bytes() const {
  constexpr std::uint64_t kBytesPerNode = sizeof(Node) + sizeof(Outline<glm::dvec3>) + sizeof(NodeLight) +
                                          3 * sizeof(Rgb) + 24 * sizeof(double);  // of the operator's vectors
  return tree_.size() * kBytesPerNode + blocks_.size() * (sizeof(Block) + 2 * sizeof(Link));
}

std::vector<NodePair> Hierarchy::first_pairs() const {
  std::vector<NodeId> front;
  if (tree_.size() > 0) front.push_back(0);
  for (std::size_t k = 0; k < front.size() && front.size() < kFirstNodes;) {
    if (!tree_.is_cluster(front[k])) {
      ++k;
      continue;
    }
    const auto [a, b] = tree_[front[k]].child;
    front.erase(front.begin() + static_cast<std::ptrdiff_t>(k));
    front.push_back(a);
    front.push_back(b);
  }
  std::vector<NodePair> pairs;
  for (std::size_t a = 0; a < front.size(); ++a)
    for (std::size_t b = a; b < front.size(); ++b) pairs.push_back({front[a], front[b]});
  return pairs;
}

/// Takes out the blocks that are not enough.
std::vector<NodePair> Hierarchy::reopen(const RefinementGoal& goal) {
  std::vector<std::uint8_t> enough(blocks_.size());
  tbb::task_arena arena(threads_);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks_.size(), 1024), [&](const auto& range) {
      for (std::size_t k = range.begin(); k < range.end(); ++k)
        enough[k] = refiner_.is_enough(blocks_[k], light_, goal) ? 1 : 0;
    });
  });
  std::vector<NodePair> open;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    if (enough[k] != 0) {
      blocks_[kept++] = blocks_[k];
    } else {
      open.push_back({blocks_[k].p, blocks_[k].q});
    }
  }
  blocks_.resize(kept);
  return ranks_.gather(std::span<const NodePair>(open));
}

/// This rank's share of the open pairs; what is still open on any rank.
std::vector<NodePair> Hierarchy::refine_share(std::span<const NodePair> open, const RefinementGoal& goal,
                                              Progress& progress) {
  // Pairs of one neighbourhood cost alike and follow each other, so that ranks take turns.
  const std::size_t count = (open.size() + ranks_.size - 1 - ranks_.rank) / ranks_.size;
  tbb::enumerable_thread_specific<RefinedPairs> of_threads;
  std::atomic<std::size_t> done = 0;
  tbb::task_arena arena(threads_);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 4), [&](const auto& range) {
      for (std::size_t k = range.begin(); k < range.end() && !is_stopped(); ++k)
        refiner_.refine(open[ranks_.rank + k * ranks_.size], light_, goal, of_threads.local());
      done += range.size();
      if (tbb::this_task_arena::current_thread_index() == 0)
        progress.update(static_cast<double>(done), static_cast<double>(count), "of the pairs that are open");
    });
  });
  RefinedPairs all;
  for (RefinedPairs& part : of_threads) {
    append(blocks_, part.blocks);
    append(all.open, part.open);
    append(all.wanted, part.wanted);
    counts_ += part.counts;
  }
  grow(std::move(all.wanted));
  return ranks_.gather(std::span<const NodePair>(all.open));
}

/// Halves what any rank wants; halves have the light of the whole.
void Hierarchy::grow(std::vector<NodeId> wanted) {
  sort_unique(wanted);
  wanted = ranks_.gather(std::span<const NodeId>(wanted));
  sort_unique(wanted);
  const std::size_t before = tree_.size();
  tree_.split(wanted);
  for (std::size_t id = before; id < tree_.size(); ++id) {
    const NodeId parent = tree_[static_cast<NodeId>(id)].parent;
    NodeLight light = light_[parent];
    light.spread /= 2;
    light_.push_back(light);
    if (!B_.empty()) B_.push_back(B_[parent]);
  }
}

bool Hierarchy::refine(double error, std::uint64_t bytes, Progress& progress) {
  RefinementGoal goal{error, mean_, false, oracle_.heat};
  std::vector<NodePair> open = links_ ? reopen(goal) : first_pairs();
  links_.reset();
  bool fits = true;
  // What was enough between leaves may not be between nodes that have been halved since.
  for (; !open.empty(); open = open.empty() ? reopen(goal) : std::move(open)) {
    open = refine_share(open, goal, progress);
    heed_signals();
    double largest = static_cast<double>(this->bytes() + open.size() * sizeof(NodePair));
    ranks_.max(std::span(&largest, 1));
    if (largest <= static_cast<double>(bytes)) continue;
    // What is open becomes blocks as it is.
    fits = false;
    goal.settle = true;
    open = refine_share(open, goal, progress);
    heed_signals();
    break;
  }
  link_blocks();
  return fits;
}

void Hierarchy::link_blocks() {
  all_blocks_ = blocks_.size();
  ranks_.sum(std::span(&all_blocks_, 1));
  leaves_ = LeafUnknowns(tree_);
  links_.emplace(tree_, blocks_);
}

bool Hierarchy::is_stopped() const { return heed_ && stop_requested(); }

void Hierarchy::heed_signals() const {
  if (heed_) heed_();
}

void Hierarchy::restore(KeptRounds kept, std::vector<Block> blocks, const RefinementCounts& counts) {
  const bool halved = tree_.halve_again(kept.halvings) && tree_.size() == kept.rounds.back().nodes;
  if (!halved || kept.radiosity.B.size() != LeafUnknowns(tree_).unknowns().size())
    throw InputError("the kept rounds do not fit the scene's tree: remove them, and begin anew");
  blocks_ = std::move(blocks);
  counts_ = counts;
  link_blocks();
  take_radiosity([&kept](RadiosityOperator&) { return std::move(kept.radiosity); });
}

void Hierarchy::solve(Solver solver, const StopRule& stop, const IterationObserver& observer) {
  const Unknowns& unknowns = leaves_.unknowns();
  std::vector<Rgb> start;
  if (!B_.empty()) {
    start.resize(unknowns.size());
    for (std::size_t k = 0; k < start.size(); ++k)
      if (const NodeId id = leaves_.nodes()[k]; id != kNoNode) start[k] = B_[id];
  }
  take_radiosity([&](RadiosityOperator& F) {
    if (solver == Solver::automatic) solver = choose_solver(row_sums_).solver;
    return solve_radiosity(solver, F, unknowns, row_sums_, stop, observer, start);
  });
}

/// What `find` makes of the blocks that there are, and what that says of the nodes.
void Hierarchy::take_radiosity(const std::function<Radiosity(RadiosityOperator&)>& find) {
  BlockOperator F(tree_, leaves_, *links_, ranks_.sum, threads_);
  const Unknowns& unknowns = leaves_.unknowns();
  row_sums_ = find_error_weights(F, unknowns, kBlockRounding, kMostSweeps);
  // Coarse blocks may send more to a node than there is: then no light could be bounded.
  std::optional<ScaledOperator> capped;
  if (!row_sums_.weights || row_sums_.largest > kRowLimits.front()) {
    const std::vector<double> sums = std::move(row_sums_.sums);
    for (const double limit : kRowLimits) {
      capped.emplace(F, cap_row_sums(sums, limit));
      row_sums_ = find_error_weights(*capped, unknowns, kBlockRounding);
      if (row_sums_.weights) break;
    }
  }
  RadiosityOperator& safe = capped ? static_cast<RadiosityOperator&>(*capped) : F;
  radiosity_ = find(safe);
  B_.assign(tree_.size(), Rgb(0));
  for (std::size_t k = 0; k < unknowns.size(); ++k)
    if (const NodeId id = leaves_.nodes()[k]; id != kNoNode) B_[id] = radiosity_->B[k];
  pull(tree_, std::span(B_));
  mean_ = mean_of_colours(mean_radiosity());
  update_light(F);
  if (oracle_.importance && !seen_.empty()) update_importance(safe);
}

}  // namespace fluxel
