#include "visibility/box_tree.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

namespace fluxel {
namespace {

using Point = BoxTree::Point;
using TreeBox = BoxTree::Box;

constexpr std::size_t kBins = 16;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Item {
  TreeBox box;
  Point centre;
  std::uint32_t number;
};

struct Group {
  TreeBox box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  std::size_t count = 0;

  void add(const TreeBox& other, std::size_t items) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min(box.low[axis], other.low[axis]);
      box.high[axis] = std::max(box.high[axis], other.high[axis]);
    }
    count += items;
  }

  /// Proportional to the work expected of a query: surface times items.
  [[nodiscard]] double cost() const {
    if (count == 0) return 0;
    const double x = box.high[0] - box.low[0], y = box.high[1] - box.low[1], z = box.high[2] - box.low[2];
    return (x * y + y * z + z * x) * static_cast<double>(count);
  }
};

using Items = std::vector<Item>::iterator;

/// Sorts the items into two parts and returns where the second begins: by the heuristic, or in halves.
Items split(Items first, Items last, bool in_halves) {
  Point low{kInfinity, kInfinity, kInfinity}, extent{-kInfinity, -kInfinity, -kInfinity};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (Items item = first; item != last; ++item) {
      low[axis] = std::min(low[axis], item->centre[axis]);
      extent[axis] = std::max(extent[axis], item->centre[axis]);
    }
    extent[axis] -= low[axis];
  }
  const auto bin_of = [&](const Item& item, std::size_t axis) {
    const double place = (item.centre[axis] - low[axis]) / extent[axis] * static_cast<double>(kBins);
    return std::min(static_cast<std::size_t>(place), kBins - 1);
  };

  double best_cost = kInfinity;
  std::size_t best_axis = 0;
  std::size_t best_bin = 0;  // the first of the second part
  for (std::size_t axis = 0; axis < 3 && !in_halves; ++axis) {
    if (!(extent[axis] > 0)) continue;
    std::array<Group, kBins> bins;
    for (Items item = first; item != last; ++item) bins[bin_of(*item, axis)].add(item->box, 1);
    std::array<double, kBins> cost_above{};
    Group above, below;
    for (std::size_t bin = kBins - 1; bin > 0; --bin) {
      above.add(bins[bin].box, bins[bin].count);
      cost_above[bin] = above.cost();
    }
    for (std::size_t bin = 1; bin < kBins; ++bin) {
      below.add(bins[bin - 1].box, bins[bin - 1].count);
      const double cost = below.cost() + cost_above[bin];
      if (cost < best_cost) std::tie(best_cost, best_axis, best_bin) = std::tuple(cost, axis, bin);
    }
  }
  if (best_bin != 0) {
    const Items second =
        std::partition(first, last, [&](const Item& item) { return bin_of(item, best_axis) < best_bin; });
    if (second != first && second != last) return second;
  }
  const std::size_t axis = extent[0] >= std::max(extent[1], extent[2]) ? 0 : extent[1] >= extent[2] ? 1 : 2;
  const Items half = first + (last - first) / 2;
  std::nth_element(first, half, last, [axis](const Item& a, const Item& b) {
    return std::tie(a.centre[axis], a.number) < std::tie(b.centre[axis], b.number);
  });
  return half;
}

struct Builder {
  BoxTree& tree;
  Items begin;

  void build(std::size_t node, Items first, Items last, int depth) {
    Group group;
    for (Items item = first; item != last; ++item) group.add(item->box, 1);
    if (group.count <= BoxTree::kLeafSize) {
      tree.nodes[node] = {group.box, static_cast<std::uint32_t>(first - begin),
                          static_cast<std::uint32_t>(group.count)};
      return;
    }
    const Items middle = split(first, last, depth >= BoxTree::kMaxHeuristicDepth);
    const std::size_t children = tree.nodes.size();
    tree.nodes.resize(children + 2);
    tree.nodes[node] = {group.box, static_cast<std::uint32_t>(children), 0};
    build(children, first, middle, depth + 1);
    build(children + 1, middle, last, depth + 1);
  }
};

}  // namespace

BoxTree::BoxTree(const std::vector<TreeBox>& boxes) {
  if (boxes.empty()) return;
  std::vector<Item> items;
  items.reserve(boxes.size());
  for (const TreeBox& box : boxes) {
    const Point centre{0.5 * (box.low[0] + box.high[0]), 0.5 * (box.low[1] + box.high[1]),
                       0.5 * (box.low[2] + box.high[2])};
    items.push_back({box, centre, static_cast<std::uint32_t>(items.size())});
  }
  nodes.resize(1);
  Builder{*this, items.begin()}.build(0, items.begin(), items.end(), 0);
  order.reserve(items.size());
  for (const Item& item : items) order.push_back(item.number);
}

}  // namespace fluxel
