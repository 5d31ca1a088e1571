#include "hierarchy/link_operator.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "solver/channels.hpp"

namespace fluxel {

namespace {

void set_channel(double& value, std::size_t, double x) { value = x; }
void set_channel(Rgb& value, std::size_t c, double x) { value[static_cast<int>(c)] = x; }

}  // namespace

LinkTable::LinkTable(const NodeTree& tree, std::span<const Link> links) : first_(tree.size() + 1) {
  for (const Link& link : links) {
    ++first_[link.p + 1];
    if (link.q != link.p) ++first_[link.q + 1];
  }
  for (std::size_t id = 0; id < tree.size(); ++id) first_[id + 1] += first_[id];
  ends_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (const Link& link : links) {
    const auto G = static_cast<double>(link.G);
    ends_[next[link.p]++] = {link.q, static_cast<float>(G / tree[link.p].shape.area), link.over_p,
                             link.over_q, link.partial};
    if (link.q == link.p) continue;  // a cluster's light within itself
    ends_[next[link.q]++] = {link.p, static_cast<float>(G / tree[link.q].shape.area), link.over_q,
                             link.over_p, link.partial};
  }
}

LinkOperator::LinkOperator(const NodeTree& tree, const LeafUnknowns& leaves, const LinkTable& table,
                           SumOverRanks sum, int threads)
    : tree_(tree), leaves_(leaves), table_(table), sum_(std::move(sum)), threads_(threads) {}

namespace {

/// A linear function over a face: its mean, and what it rises by from the centroid to its extent along each
/// axis; or of a density its mean and its first moments about the centroid over area and extents.
template <class T>
struct Linear {
  T mean{0}, u{0}, v{0};
};

/// Of a cluster, by each way.
template <class T>
using ByWay = std::array<T, kWays>;

/// What nodes send or have received: clusters by each way, faces as linear functions.
template <class T>
struct NodeValues {
  explicit NodeValues(const NodeTree& tree) : of_clusters(tree.clusters()), of_nodes(tree.size()) {
    for (ByWay<T>& ways : of_clusters) ways.fill(T(0));
  }

  std::vector<ByWay<T>> of_clusters;
  std::vector<Linear<T>> of_nodes;  // of clusters nothing
};

/// What nodes send, from what leaves do: means and first moments.
template <class Value>
void pull_moments(const NodeTree& tree, NodeValues<Value>& sent) {
  for (std::size_t k = tree.size(); k-- > 0;) {
    const auto id = static_cast<NodeId>(k);
    const Node& node = tree[id];
    if (node.is_leaf()) continue;
    if (tree.is_cluster(id)) {
      for (const NodeId child : node.child)
        for (std::size_t way = 0; way < kWays; ++way)
          sent.of_clusters[id][way] +=
              tree.shares(child)[way] *
              (tree.is_cluster(child) ? sent.of_clusters[child][way] : sent.of_nodes[child].mean);
      continue;
    }
    Linear<Value> sum;
    for (const NodeId child : node.child) {
      // Both halves have half the area.
      const glm::dvec2 offset = tree.place(id, tree[child].shape.centroid);
      const glm::dvec2 shrunk = tree.shrinking(id, child);
      const Linear<Value>& part = sent.of_nodes[child];
      sum.mean += 0.5 * part.mean;
      sum.u += 0.5 * (shrunk.x * part.u + offset.x * part.mean);
      sum.v += 0.5 * (shrunk.y * part.v + offset.y * part.mean);
    }
    sent.of_nodes[id] = sum;
  }
}

/// What nodes have received reaches all below them; of a cluster each as much as it takes.
void push(const NodeTree& tree, NodeValues<double>& received) {
  for (std::size_t k = 0; k < tree.size(); ++k) {
    const auto id = static_cast<NodeId>(k);
    const Node& node = tree[id];
    if (node.is_leaf()) continue;
    const Linear<double> whole = received.of_nodes[id];
    for (const NodeId child : node.child) {
      if (tree.is_cluster(id)) {
        const double over = node.shape.area / tree[child].shape.area;
        for (std::size_t way = 0; way < kWays; ++way) {
          const double part = tree.shares(child)[way] * over * received.of_clusters[id][way];
          (tree.is_cluster(child) ? received.of_clusters[child][way] : received.of_nodes[child].mean) += part;
        }
        continue;
      }
      const glm::dvec2 offset = tree.place(id, tree[child].shape.centroid);
      const glm::dvec2 shrunk = tree.shrinking(id, child);
      received.of_nodes[child].mean += whole.mean + offset.x * whole.u + offset.y * whole.v;
      received.of_nodes[child].u += shrunk.x * whole.u;
      received.of_nodes[child].v += shrunk.y * whole.v;
    }
  }
}

/// Where the whole numbers that a node receives stand: of a cluster one by each way, of a face a mean and two
/// slopes, each for every channel.
template <std::size_t kCount>
class Places {
 public:
  static constexpr std::size_t kOfCluster = kWays * kCount, kOfFace = 3 * kCount;

  explicit Places(const NodeTree& tree) : tree_(tree) {}

  [[nodiscard]] std::size_t size() const { return at(tree_.size()); }
  [[nodiscard]] std::size_t at(std::size_t id) const {
    const std::size_t clusters = std::min(id, tree_.clusters());
    return clusters * kOfCluster + (id - clusters) * kOfFace;
  }

 private:
  const NodeTree& tree_;
};

template <class Value>
double largest_channel(const Value& value) {
  double largest = 0;
  for (std::size_t c = 0; c < kChannelsOf<Value>; ++c)
    largest = std::max(largest, std::abs(channel(value, static_cast<int>(c))));
  return largest;
}

/// What any nodes without a leaf in common send is no more [W]: a cluster may send by one way more than its
/// leaves do in all.
template <class Value>
double most_sent(const NodeTree& tree, const NodeValues<Value>& sent) {
  std::vector<double> power(tree.size());
  for (std::size_t k = tree.size(); k-- > 0;) {
    const auto id = static_cast<NodeId>(k);
    const Node& node = tree[id];
    if (node.is_leaf()) {
      power[id] = node.shape.area * largest_channel(sent.of_nodes[id].mean);
      continue;
    }
    for (const NodeId child : node.child) power[id] += power[child];
    if (!tree.is_cluster(id)) continue;
    for (const Value& by_way : sent.of_clusters[id])
      power[id] = std::max(power[id], node.shape.area * largest_channel(by_way));
  }
  return power.empty() ? 0 : power.front();
}

/// Of each node, for sums of what it receives: row sums are about 1, so that it gets on average at most the
/// largest value, and no more than all power, which counts where a lamp is tiny. Sums may be 2^10 times that.
template <class Value>
std::vector<double> units_of(const NodeTree& tree, std::span<const Value> x, const NodeValues<Value>& sent) {
  double largest = 0;
  for (const Value& value : x) largest = std::max(largest, largest_channel(value));
  const double power = most_sent(tree, sent);
  std::vector<double> units(tree.size(), 1.0);
  for (std::size_t id = 0; id < tree.size(); ++id) {
    const double most = std::min(largest, power / tree[static_cast<NodeId>(id)].shape.area);
    if (most > 0) units[id] = std::ldexp(1.0, std::ilogb(most) - 52);
  }
  return units;
}

}  // namespace

template <class Value>
void LinkOperator::apply_to(std::span<const Value> x, std::span<Value> H,
                            std::span<std::array<Value, 2>> slopes) {
  constexpr std::size_t kCount = kChannelsOf<Value>;
  NodeValues<Value> sent(tree_);
  for (std::size_t k = 0; k < x.size(); ++k)
    if (const NodeId id = leaves_.nodes()[k]; id != kNoNode) sent.of_nodes[id].mean = x[k];
  pull_moments(tree_, sent);
  const std::vector<double> units = units_of(tree_, x, sent);
  const Places<kCount> places(tree_);
  std::vector<std::uint64_t> received(places.size());
  tbb::task_arena arena(threads_);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tree_.size(), 256), [&](const auto& range) {
      for (std::size_t k = range.begin(); k < range.end(); ++k) {
        const auto id = static_cast<NodeId>(k);
        std::array<std::int64_t, Places<kCount>::kOfCluster> sum{};
        for (const LinkEnd& end : table_.of(id)) {
          const double F = static_cast<double>(end.F) / units[id];
          WayParts ways;
          if (tree_.is_cluster(id) || tree_.is_cluster(end.from))
            ways = way_parts(tree_[end.from].shape.centroid - tree_[id].shape.centroid);
          for (std::size_t c = 0; c < kCount; ++c) {
            const int colour = static_cast<int>(c);
            double light = 0;
            if (tree_.is_cluster(end.from)) {
              const ByWay<Value>& from = sent.of_clusters[end.from];
              for (std::size_t n = 0; n < ways.way.size(); ++n)
                light += F * ways.part[n] * channel(from[opposite(ways.way[n])], colour);
            } else {
              const Linear<Value>& from = sent.of_nodes[end.from];
              const double of_slope =
                  end.there.u * channel(from.u, colour) + end.there.v * channel(from.v, colour);
              light = F * (channel(from.mean, colour) + of_slope / kSlopeOne);
            }
            if (tree_.is_cluster(id)) {
              for (std::size_t n = 0; n < ways.way.size(); ++n)
                sum[ways.way[n] * kCount + c] += std::llrint(ways.part[n] * light);
            } else {
              sum[c] += std::llrint(light);
              sum[kCount + c] += std::llrint(light * end.here.u / kSlopeOne);
              sum[2 * kCount + c] += std::llrint(light * end.here.v / kSlopeOne);
            }
          }
        }
        for (std::size_t n = places.at(id); n < places.at(id + 1); ++n)
          received[n] = static_cast<std::uint64_t>(sum[n - places.at(id)]);
      }
    });
  });
  sum_(received);
  for (std::size_t c = 0; c < kCount; ++c) {
    const auto term = [&](std::size_t id, std::size_t n) {
      return units[id] *
             static_cast<double>(static_cast<std::int64_t>(received[places.at(id) + n * kCount + c]));
    };
    NodeValues<double> light(tree_);
    for (std::size_t id = 0; id < tree_.clusters(); ++id)
      for (std::size_t way = 0; way < kWays; ++way) light.of_clusters[id][way] = term(id, way);
    for (std::size_t id = tree_.clusters(); id < tree_.size(); ++id)
      light.of_nodes[id] = {term(id, 0), term(id, 1), term(id, 2)};
    push(tree_, light);
    for (std::size_t k = 0; k < x.size(); ++k) {
      const NodeId id = leaves_.nodes()[k];
      const Linear<double> at = id == kNoNode ? Linear<double>{} : light.of_nodes[id];
      set_channel(H[k], c, at.mean);
      if (slopes.empty()) continue;
      set_channel(slopes[k][0], c, at.u);
      set_channel(slopes[k][1], c, at.v);
    }
  }
}

void LinkOperator::apply_with_slopes(std::span<const Rgb> x, std::span<Rgb> H,
                                     std::span<std::array<Rgb, 2>> slopes) {
  apply_to(x, H, slopes);
}
void LinkOperator::apply(std::span<const Rgb> x, std::span<Rgb> H) { apply_to(x, H); }
void LinkOperator::apply(std::span<const double> x, std::span<double> H) { apply_to(x, H); }

void LinkOperator::sweep(std::span<const Rgb>, std::span<const Rgb>, std::span<Rgb>) {
  throw std::logic_error("links have no rows to sweep over");
}
void LinkOperator::sweep(std::span<const double>, std::span<const double>, std::span<double>) {
  throw std::logic_error("links have no rows to sweep over");
}

}  // namespace fluxel
