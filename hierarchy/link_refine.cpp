// How links are refined: the rest of LinkHierarchy.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <deque>
#include <utility>

#include "hierarchy/link_hierarchy.hpp"

namespace fluxel {

namespace {

/// Nodes between all pairs of which refinement begins, so that there is something to share.
constexpr std::size_t kFirstNodes = 128;

/// A batch is so many pairs, each followed down for so many visits. Where memory is short it is fewer pairs.
constexpr std::size_t kBatchPairs = 1024, kMinBatchPairs = 16;
constexpr std::size_t kVisits = 64;
/// Of a batch, for one thread: each has lists of its own.
constexpr std::size_t kPairsAtOnce = 8;

/// A visit adds so many pairs at most: a cluster within itself becomes three.
constexpr std::uint64_t kAddedByVisit = 2;

/// A link takes its own place and one in the table for each of its nodes.
constexpr std::uint64_t kBytesPerLink = sizeof(Link) + 2 * sizeof(LinkEnd);
constexpr std::uint64_t kBytesPerNode = sizeof(Node) + sizeof(Outline<glm::dvec3>) + sizeof(NodeLight) +
                                        3 * sizeof(Rgb) + 24 * sizeof(double);  // of the operator's vectors
/// What it takes more: its children's shares, and what it sends and receives by each way.
constexpr std::uint64_t kBytesPerCluster = 2 * sizeof(WayShares) + 2 * kWays * sizeof(Rgb);

template <class T>
void append_all(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

/// A way through pairs that are open, on the tree as it is.
struct LinkHierarchy::Pass {
  enum class Order {
    depth_first,    ///< few pairs are on their way at once
    breadth_first,  ///< all are about as far, wherever it ends
  };

  Order order = Order::depth_first;
  std::vector<NodePair> given;      // to this rank
  std::size_t begun = 0;            // of them
  std::deque<PendingPair> pending;  // of those that have been begun
  std::vector<NodePair> open;       // that ask for halves
  Votes votes;

  [[nodiscard]] std::size_t waiting() const { return given.size() - begun + pending.size(); }

  /// What is open takes at least as much as links, sooner or later, and likewise what a breadth-first pass
  /// leaves; a depth-first one ends with nothing waiting.
  [[nodiscard]] std::uint64_t bytes() const {
    return open.size() * kBytesPerLink +
           waiting() * (order == Order::depth_first ? sizeof(PendingPair) : kBytesPerLink);
  }

  [[nodiscard]] std::vector<PendingPair> take(std::size_t count) {
    std::vector<PendingPair> taken;
    const auto take_given = [&] {
      while (taken.size() < count && begun < given.size()) taken.push_back({given[begun++]});
    };
    if (order == Order::breadth_first) take_given();
    while (taken.size() < count && !pending.empty()) {
      const bool last = order == Order::depth_first;
      taken.push_back(last ? pending.back() : pending.front());
      last ? pending.pop_back() : pending.pop_front();
    }
    take_given();
    return taken;
  }
};

std::uint64_t LinkHierarchy::bytes() const {
  return tree_.size() * kBytesPerNode + tree_.clusters() * kBytesPerCluster + links_.size() * kBytesPerLink +
         first_light_.bytes();
}

/// This rank's share of the pairs that it all begins with.
std::vector<NodePair> LinkHierarchy::first_pairs() const {
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
  std::size_t turn = 0;
  for (std::size_t a = 0; a < front.size(); ++a)
    for (std::size_t b = a; b < front.size(); ++b)
      if (turn++ % ranks_.size == ranks_.rank) pairs.push_back({front[a], front[b]});
  return pairs;
}

/// Takes out the links that are not enough; this rank's share of them as pairs.
std::vector<NodePair> LinkHierarchy::reopen(const RefinementGoal& goal) {
  std::vector<std::uint8_t> enough(links_.size());
  const LinkOracle oracle = refiner_.oracle(light_, goal);
  tbb::task_arena arena(threads_);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, links_.size(), 1024), [&](const auto& range) {
      for (std::size_t k = range.begin(); k < range.end(); ++k)
        enough[k] = oracle.is_enough(links_[k]) ? 1 : 0;
    });
  });
  std::vector<NodePair> open;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < links_.size(); ++k) {
    if (enough[k] != 0) {
      links_[kept++] = links_[k];
    } else {
      open.push_back({links_[k].p, links_[k].q});
    }
  }
  links_.resize(kept);
  return distribute(ranks_, std::move(open));
}

/// Refines in batches until nothing waits any more, or this rank's memory is used up or it is to end: then it
/// says false.
/// Links, and what is open or waits, depend on the memory, but not on the threads.
bool LinkHierarchy::run(Pass& pass, const RefinementGoal& goal, std::uint64_t bytes, Progress& progress) {
  const std::size_t visits = pass.order == Pass::Order::depth_first ? kVisits : 1;
  for (;;) {
    const std::uint64_t taken = this->bytes() + pass.bytes();
    if (taken > bytes) return false;
    if (pass.waiting() == 0 || is_stopped()) return true;
    if (is_time_to_end()) return false;
    const std::uint64_t room = (bytes - taken) / (kAddedByVisit * visits * kBytesPerLink);
    refine_batch(pass, std::clamp<std::size_t>(room, kMinBatchPairs, kBatchPairs), visits, goal);
    progress.update(static_cast<double>(pass.begun), static_cast<double>(pass.given.size()),
                    "of the pairs that are open");
  }
}

void LinkHierarchy::refine_batch(Pass& pass, std::size_t pairs, std::size_t visits,
                                 const RefinementGoal& goal) {
  const std::vector<PendingPair> batch = pass.take(pairs);
  std::vector<RefinedPairs> found((batch.size() + kPairsAtOnce - 1) / kPairsAtOnce);
  tbb::task_arena arena(threads_);
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t part) {
      const std::size_t last = std::min(batch.size(), (part + 1) * kPairsAtOnce);
      for (std::size_t k = part * kPairsAtOnce; k < last && !is_stopped(); ++k)
        refiner_.refine(batch[k], light_, goal, visits, found[part]);
    });
  });
  for (const RefinedPairs& part : found) {
    append_all(links_, part.links);
    append_all(pass.open, part.open);
    pass.pending.insert(pass.pending.end(), part.pending.begin(), part.pending.end());
    for (const auto& [halving, weight] : part.wanted) pass.votes[halving.leaf][halving.edge] += weight;
    counts_ += part.counts;
  }
}

/// What any rank wants to be halved, ascending, each by the edge that most of all ranks' weight is for.
std::vector<Halving> LinkHierarchy::wanted_by_any(const Votes& votes) const {
  struct OfLeaf {
    NodeId leaf;
    std::array<std::uint64_t, 3> weights;
  };
  std::vector<OfLeaf> mine;
  mine.reserve(votes.size());
  for (const auto& [leaf, weights] : votes) mine.push_back({leaf, weights});
  Votes all;
  gather_in_parts(ranks_, std::span<const OfLeaf>(mine), [&all](const OfLeaf& of_rank) {
    std::array<std::uint64_t, 3>& sum = all[of_rank.leaf];
    for (std::size_t edge = 0; edge < sum.size(); ++edge) sum[edge] += of_rank.weights[edge];
  });
  std::vector<Halving> wanted;
  for (const auto& [leaf, weights] : all)
    wanted.push_back({leaf, static_cast<std::uint32_t>(std::ranges::max_element(weights) - weights.begin())});
  return wanted;
}

/// Nodes that the tree gets when these are halved.
std::size_t LinkHierarchy::count_halves(std::span<const Halving> wanted) const {
  std::size_t count = 0;
  for (const auto& [id, edge] : wanted) {
    const NodeId twin = tree_[id].twin;
    if (twin == kNoNode) {
      count += 2;
    } else if (twin > id || !std::ranges::binary_search(wanted, twin, {}, &Halving::leaf)) {
      count += 4;
    }
  }
  return count;
}

/// For the last pass, where a whole one has no room: as fine as the memory allows, everywhere alike, and what
/// is open then becomes links as it is; without any memory at once.
void LinkHierarchy::settle(std::vector<NodePair> open, RefinementGoal goal, std::uint64_t bytes,
                           Progress& progress) {
  Pass pass;
  pass.order = Pass::Order::breadth_first;
  pass.given = std::move(open);
  static_cast<void>(run(pass, goal, bytes, progress));
  for (const NodePair& pair : std::exchange(pass.open, {})) pass.pending.push_back({pair});
  goal.settle = true;
  while (pass.waiting() > 0 && !is_stopped()) refine_batch(pass, kBatchPairs, 1, goal);
  handle_signals();
}

bool LinkHierarchy::refine(double error, std::uint64_t bytes, Progress& progress) {
  const RefinementGoal goal{error, mean_, false, oracle_.heat};
  std::size_t examined = table_ ? tree_.size() : 0;  // nodes when all links were last looked at
  std::vector<NodePair> open = table_ ? reopen(goal) : first_pairs();
  table_.reset();
  bool fits = true;
  while (fits && is_any(ranks_, !open.empty())) {
    const std::size_t before = links_.size();
    Pass pass;
    pass.given = std::exchange(open, {});
    const bool done = run(pass, goal, bytes, progress);
    handle_signals();
    const std::vector<Halving> wanted = wanted_by_any(pass.votes);
    const std::uint64_t grown = this->bytes() + pass.bytes() + count_halves(wanted) * kBytesPerNode;
    const bool ends = is_any(ranks_, is_time_to_end()) && is_any(ranks_, !done || !pass.open.empty());
    fits = !is_any(ranks_, !done || grown > bytes) && !ends;
    if (fits) {
      grow(wanted);
      open = distribute(ranks_, std::move(pass.open));
      // What was enough between leaves may not be between nodes that have been halved since. Where none have,
      // links would be made anew as they are.
      if (!is_any(ranks_, !open.empty()) && tree_.size() > examined) {
        examined = tree_.size();
        open = reopen(goal);
      }
    } else {
      links_.resize(before);
      settle(std::move(pass.given), goal, ends ? 0 : bytes, progress);
    }
  }
  make_table();
  return fits;
}

void LinkHierarchy::make_table() {
  all_links_ = links_.size();
  ranks_.sum(std::span(&all_links_, 1));
  leaves_ = LeafUnknowns(tree_);
  find_first_light();
  table_.emplace(tree_, links_);
}

}  // namespace fluxel
