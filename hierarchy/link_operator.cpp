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

/// Means and first moments of all nodes, from those of the leaves; of clusters what they send.
template <class Value>
void pull_moments(const NodeTree& tree, std::vector<Linear<Value>>& of_nodes) {
  for (std::size_t k = tree.size(); k-- > 0;) {
    const auto id = static_cast<NodeId>(k);
    const Node& node = tree[id];
    if (node.is_leaf()) continue;
    Linear<Value> sum;
    if (tree.is_cluster(id)) {
      for (const NodeId child : node.child) of_nodes[id].mean += tree.share(child) * of_nodes[child].mean;
      continue;
    }
    for (const NodeId child : node.child) {
      // Both halves have half the area.
      const glm::dvec2 offset = tree.place(id, tree[child].shape.centroid);
      const glm::dvec2 shrunk = tree.shrinking(id, child);
      const Linear<Value>& part = of_nodes[child];
      sum.mean += 0.5 * part.mean;
      sum.u += 0.5 * (shrunk.x * part.u + offset.x * part.mean);
      sum.v += 0.5 * (shrunk.y * part.v + offset.y * part.mean);
    }
    of_nodes[id] = sum;
  }
}

/// What nodes have received reaches all below them; of a cluster each as much as it takes.
void push(const NodeTree& tree, std::vector<Linear<double>>& of_nodes) {
  for (std::size_t k = 0; k < tree.size(); ++k) {
    const auto id = static_cast<NodeId>(k);
    const Node& node = tree[id];
    if (node.is_leaf()) continue;
    const Linear<double>& whole = of_nodes[id];
    for (const NodeId child : node.child) {
      if (tree.is_cluster(id)) {
        of_nodes[child].mean += tree.share(child) * node.shape.area / tree[child].shape.area * whole.mean;
        continue;
      }
      const glm::dvec2 offset = tree.place(id, tree[child].shape.centroid);
      const glm::dvec2 shrunk = tree.shrinking(id, child);
      of_nodes[child].mean += whole.mean + offset.x * whole.u + offset.y * whole.v;
      of_nodes[child].u += shrunk.x * whole.u;
      of_nodes[child].v += shrunk.y * whole.v;
    }
  }
}

}  // namespace

template <class Value>
void LinkOperator::apply_to(std::span<const Value> x, std::span<Value> H,
                            std::span<std::array<Value, 2>> slopes) {
  constexpr std::size_t kCount = kChannelsOf<Value>, kTerms = 3 * kCount;
  std::vector<Linear<Value>> sent(tree_.size());
  double largest = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const NodeId id = leaves_.nodes()[k];
    if (id == kNoNode) continue;
    sent[id].mean = x[k];
    for (std::size_t c = 0; c < kCount; ++c)
      largest = std::max(largest, std::abs(channel(x[k], static_cast<int>(c))));
  }
  pull_moments(tree_, sent);
  // Row sums are about 1, so that 2^10 times the largest value holds every sum.
  const double unit = largest > 0 ? std::ldexp(1.0, std::ilogb(largest) - 52) : 1.0;
  std::vector<std::uint64_t> received(tree_.size() * kTerms);
  tbb::task_arena arena(threads_);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tree_.size(), 256), [&](const auto& range) {
      for (std::size_t id = range.begin(); id < range.end(); ++id) {
        std::int64_t sum[kTerms] = {};
        for (const LinkEnd& end : table_.of(static_cast<NodeId>(id))) {
          const double F = static_cast<double>(end.F) / unit;
          const Linear<Value>& from = sent[end.from];
          for (std::size_t c = 0; c < kCount; ++c) {
            const int colour = static_cast<int>(c);
            const double of_slope =
                end.there.u * channel(from.u, colour) + end.there.v * channel(from.v, colour);
            const double light = F * (channel(from.mean, colour) + of_slope / kSlopeOne);
            sum[c] += std::llrint(light);
            sum[kCount + c] += std::llrint(light * end.here.u / kSlopeOne);
            sum[2 * kCount + c] += std::llrint(light * end.here.v / kSlopeOne);
          }
        }
        for (std::size_t k = 0; k < kTerms; ++k)
          received[id * kTerms + k] = static_cast<std::uint64_t>(sum[k]);
      }
    });
  });
  sum_(received);
  std::vector<Linear<double>> light(tree_.size());
  for (std::size_t c = 0; c < kCount; ++c) {
    const auto term = [&](std::size_t id, std::size_t k) {
      return unit * static_cast<double>(static_cast<std::int64_t>(received[id * kTerms + k * kCount + c]));
    };
    for (std::size_t id = 0; id < tree_.size(); ++id) light[id] = {term(id, 0), term(id, 1), term(id, 2)};
    push(tree_, light);
    for (std::size_t k = 0; k < x.size(); ++k) {
      const NodeId id = leaves_.nodes()[k];
      const Linear<double> at = id == kNoNode ? Linear<double>{} : light[id];
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
