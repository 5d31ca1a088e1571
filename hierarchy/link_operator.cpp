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

LinkOperator::LinkOperator(const LinkedNodes& linked, const LinkTable& table, SumOverRanks sum, int threads)
    : linked_(linked), table_(table), sum_(std::move(sum)), threads_(threads) {}

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

/// What linked nodes send or have received: clusters by each way, faces as linear functions.
template <class T>
struct NodeValues {
  explicit NodeValues(const LinkedNodes& linked)
      : of_clusters(linked.clusters()), of_faces(linked.nodes().size() - linked.clusters()) {
    for (ByWay<T>& ways : of_clusters) ways.fill(T(0));
  }

  [[nodiscard]] bool is_cluster(std::size_t place) const { return place < of_clusters.size(); }
  [[nodiscard]] ByWay<T>& cluster(std::size_t place) { return of_clusters[place]; }
  [[nodiscard]] const ByWay<T>& cluster(std::size_t place) const { return of_clusters[place]; }
  [[nodiscard]] Linear<T>& face(std::size_t place) { return of_faces[place - of_clusters.size()]; }
  [[nodiscard]] const Linear<T>& face(std::size_t place) const {
    return of_faces[place - of_clusters.size()];
  }

  std::vector<ByWay<T>> of_clusters;
  std::vector<Linear<T>> of_faces;
};

template <class Value>
double largest_channel(const Value& value) {
  double largest = 0;
  for (std::size_t c = 0; c < kChannelsOf<Value>; ++c)
    largest = std::max(largest, std::abs(channel(value, static_cast<int>(c))));
  return largest;
}

/// What leaves and bundles send of x [W/m2], and the power that their leaves send [W], of the largest
/// channel.
template <class Value>
void send_from_leaves(const LinkedNodes& linked, std::span<const Value> x, NodeValues<Value>& sent,
                      std::span<double> power) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, linked.nodes().size(), 64), [&](const auto& range) {
    for (std::size_t k = range.begin(); k < range.end(); ++k) {
      const LinkedNode& node = linked.nodes()[k];
      const double area = linked.tree()[node.id].shape.area;
      if (!sent.is_cluster(k)) {
        if (node.unknown == LinkedNode::kNone) continue;
        sent.face(k).mean = x[node.unknown];
        power[k] = area * largest_channel(x[node.unknown]);
        continue;
      }
      for (const BundledLeaf& leaf : linked.leaves_of(node)) {
        for (std::size_t way = 0; way < kWays; ++way)
          sent.cluster(k)[way] += leaf.shares[way] * (leaf.part_of_face * x[leaf.unknown]);
        power[k] += area / leaf.cluster_over_face * leaf.part_of_face * largest_channel(x[leaf.unknown]);
      }
    }
  });
}

/// What nodes send, from what those below do: means and first moments. `power` [W] becomes a bound of what
/// nodes below without a leaf in common send together: a cluster may send by one way more than its leaves do
/// in all.
template <class Value>
void pull_moments(const LinkedNodes& linked, NodeValues<Value>& sent, std::span<double> power) {
  const NodeTree& tree = linked.tree();
  for (std::size_t k = linked.nodes().size(); k-- > 0;) {
    const LinkedNode& node = linked.nodes()[k];
    const bool is_cluster = sent.is_cluster(k);
    if (node.child[0] != LinkedNode::kNone) {
      Linear<Value> sum;
      for (const std::uint32_t child : node.child) {
        const NodeId id = linked.nodes()[child].id;
        power[k] += power[child];
        if (is_cluster) {
          const WayShares shares = tree.shares(id);
          for (std::size_t way = 0; way < kWays; ++way)
            sent.cluster(k)[way] +=
                shares[way] * (sent.is_cluster(child) ? sent.cluster(child)[way] : sent.face(child).mean);
          continue;
        }
        // Both halves have half the area.
        const glm::dvec2 offset = tree.place(node.id, tree[id].shape.centroid);
        const glm::dvec2 shrunk = tree.shrinking(node.id, id);
        const Linear<Value>& part = sent.face(child);
        sum.mean += 0.5 * part.mean;
        sum.u += 0.5 * (shrunk.x * part.u + offset.x * part.mean);
        sum.v += 0.5 * (shrunk.y * part.v + offset.y * part.mean);
      }
      if (!is_cluster) sent.face(k) = sum;
    }
    if (!is_cluster) continue;
    for (const Value& by_way : sent.cluster(k))
      power[k] = std::max(power[k], tree[node.id].shape.area * largest_channel(by_way));
  }
}

/// What nodes have received reaches all below them; of a cluster each as much as it takes.
template <class Value>
void push(const LinkedNodes& linked, NodeValues<Value>& received) {
  const NodeTree& tree = linked.tree();
  for (std::size_t k = 0; k < linked.nodes().size(); ++k) {
    const LinkedNode& node = linked.nodes()[k];
    if (node.child[0] == LinkedNode::kNone) continue;
    for (const std::uint32_t child : node.child) {
      const NodeId id = linked.nodes()[child].id;
      if (received.is_cluster(k)) {
        const double over = tree[node.id].shape.area / tree[id].shape.area;
        const WayShares shares = tree.shares(id);
        for (std::size_t way = 0; way < kWays; ++way) {
          const Value part = (shares[way] * over) * received.cluster(k)[way];
          (received.is_cluster(child) ? received.cluster(child)[way] : received.face(child).mean) += part;
        }
        continue;
      }
      const Linear<Value>& whole = received.face(k);
      const glm::dvec2 offset = tree.place(node.id, tree[id].shape.centroid);
      const glm::dvec2 shrunk = tree.shrinking(node.id, id);
      Linear<Value>& part = received.face(child);
      part.mean += whole.mean + offset.x * whole.u + offset.y * whole.v;
      part.u += shrunk.x * whole.u;
      part.v += shrunk.y * whole.v;
    }
  }
}

/// What leaves and those of bundles have of it. `slopes` may be empty; what a cluster shares out has none.
template <class Value>
void receive_at_leaves(const LinkedNodes& linked, const NodeValues<Value>& received, std::span<Value> H,
                       std::span<std::array<Value, 2>> slopes) {
  std::ranges::fill(H, Value(0));
  std::ranges::fill(slopes, std::array<Value, 2>{Value(0), Value(0)});
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, linked.nodes().size(), 64), [&](const auto& range) {
    for (std::size_t k = range.begin(); k < range.end(); ++k) {
      const LinkedNode& node = linked.nodes()[k];
      for (const BundledLeaf& leaf : linked.leaves_of(node)) {
        Value sum(0);
        for (std::size_t way = 0; way < kWays; ++way) sum += leaf.shares[way] * received.cluster(k)[way];
        H[leaf.unknown] = leaf.cluster_over_face * sum;
      }
      if (node.unknown == LinkedNode::kNone) continue;
      const Linear<Value>& at = received.face(k);
      H[node.unknown] = at.mean;
      if (!slopes.empty()) slopes[node.unknown] = {at.u, at.v};
    }
  });
}

/// Where the whole numbers that a linked node receives stand: of a cluster one by each way, of a face a mean
/// and two slopes, each for every channel.
template <std::size_t kCount>
class Places {
 public:
  static constexpr std::size_t kOfCluster = kWays * kCount, kOfFace = 3 * kCount;

  explicit Places(const LinkedNodes& linked) : linked_(linked) {}

  [[nodiscard]] std::size_t size() const { return at(linked_.nodes().size()); }
  [[nodiscard]] std::size_t at(std::size_t place) const {
    const std::size_t clusters = std::min(place, linked_.clusters());
    return clusters * kOfCluster + (place - clusters) * kOfFace;
  }

 private:
  const LinkedNodes& linked_;
};

/// Of each node, for sums of what it receives: row sums are about 1, so that it gets on average at most the
/// largest value, and no more than all power, which counts where a lamp is tiny. Sums may be 2^10 times that.
template <class Value>
std::vector<double> units_of(const LinkedNodes& linked, std::span<const Value> x, double power) {
  double largest = 0;
  for (const Value& value : x) largest = std::max(largest, largest_channel(value));
  std::vector<double> units(linked.nodes().size(), 1.0);
  for (std::size_t k = 0; k < units.size(); ++k) {
    const double most = std::min(largest, power / linked.tree()[linked.nodes()[k].id].shape.area);
    if (most > 0) units[k] = std::ldexp(1.0, std::ilogb(most) - 52);
  }
  return units;
}

/// What the other node of a link sends along it [W/m2], in one channel; of a cluster the mean over `ways`, on
/// which the light arrives.
template <class Value>
double light_of(const LinkEnd& end, const WayParts& ways, const NodeValues<Value>& sent, std::size_t from,
                int colour) {
  double light = 0;
  if (sent.is_cluster(from)) {
    for (std::size_t n = 0; n < ways.way.size(); ++n)
      light += ways.part[n] * channel(sent.cluster(from)[opposite(ways.way[n])], colour);
    return light;
  }
  const Linear<Value>& face = sent.face(from);
  return channel(face.mean, colour) +
         (end.there.u * channel(face.u, colour) + end.there.v * channel(face.v, colour)) / kSlopeOne;
}

}  // namespace

template <class Value>
void LinkOperator::apply_to(std::span<const Value> x, std::span<Value> H,
                            std::span<std::array<Value, 2>> slopes) {
  constexpr std::size_t kCount = kChannelsOf<Value>;
  const NodeTree& tree = linked_.tree();
  const std::span<const LinkedNode> nodes = linked_.nodes();
  tbb::task_arena arena(threads_);
  NodeValues<Value> sent(linked_);
  std::vector<double> power(nodes.size());
  arena.execute([&] { send_from_leaves(linked_, x, sent, std::span(power)); });
  pull_moments(linked_, sent, std::span(power));
  const std::vector<double> units = units_of(linked_, x, power.empty() ? 0 : power.front());
  const Places<kCount> places(linked_);
  std::vector<std::uint64_t> received(places.size());
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, nodes.size(), 256), [&](const auto& range) {
      for (std::size_t k = range.begin(); k < range.end(); ++k) {
        const NodeId id = nodes[k].id;
        std::array<std::int64_t, Places<kCount>::kOfCluster> sum{};
        for (const LinkEnd& end : table_.of(id)) {
          const double F = static_cast<double>(end.F) / units[k];
          const std::size_t from = linked_.place(end.from);
          WayParts ways;
          if (sent.is_cluster(k) || sent.is_cluster(from))
            ways = way_parts(tree[end.from].shape.centroid - tree[id].shape.centroid);
          for (std::size_t c = 0; c < kCount; ++c) {
            const double light = F * light_of(end, ways, sent, from, static_cast<int>(c));
            if (sent.is_cluster(k)) {
              for (std::size_t n = 0; n < ways.way.size(); ++n)
                sum[ways.way[n] * kCount + c] += std::llrint(ways.part[n] * light);
            } else {
              sum[c] += std::llrint(light);
              sum[kCount + c] += std::llrint(light * end.here.u / kSlopeOne);
              sum[2 * kCount + c] += std::llrint(light * end.here.v / kSlopeOne);
            }
          }
        }
        for (std::size_t n = places.at(k); n < places.at(k + 1); ++n)
          received[n] = static_cast<std::uint64_t>(sum[n - places.at(k)]);
      }
    });
  });
  sum_(received);
  NodeValues<Value> light(linked_);
  const auto term = [&](std::size_t k, std::size_t n) {
    Value value(0);
    for (std::size_t c = 0; c < kCount; ++c)
      set_channel(
          value, c,
          units[k] * static_cast<double>(static_cast<std::int64_t>(received[places.at(k) + n * kCount + c])));
    return value;
  };
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (light.is_cluster(k)) {
      for (std::size_t way = 0; way < kWays; ++way) light.cluster(k)[way] = term(k, way);
    } else {
      light.face(k) = {term(k, 0), term(k, 1), term(k, 2)};
    }
  }
  push(linked_, light);
  arena.execute([&] { receive_at_leaves(linked_, light, H, slopes); });
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
