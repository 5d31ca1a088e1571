#include "visibility/patch_tree.hpp"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <iterator>
#include <limits>
#include <tuple>

namespace fluxel {
namespace {

constexpr std::size_t kLeafSize = 4;
constexpr std::size_t kBins = 16;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Item {
  Box box;
  glm::dvec3 centre;
  PatchId id;
};

struct Group {
  Box box{glm::dvec3(kInfinity), glm::dvec3(-kInfinity)};
  std::size_t count = 0;

  void add(const Box& other, std::size_t items) {
    box.low = glm::min(box.low, other.low);
    box.high = glm::max(box.high, other.high);
    count += items;
  }

  /// Proportional to the work expected of a query: surface times items.
  [[nodiscard]] double cost() const {
    if (count == 0) return 0;
    const glm::dvec3 size = box.high - box.low;
    return (size.x * size.y + size.y * size.z + size.z * size.x) * static_cast<double>(count);
  }
};

/// Sorts the items into two parts and returns the size of the first: by the surface area heuristic over bins
/// of the centres (Wald, On fast construction of SAH-based bounding volume hierarchies, 2007), or in halves.
std::size_t split(std::span<Item> items, bool in_halves) {
  glm::dvec3 low(kInfinity), high(-kInfinity);
  for (const Item& item : items) {
    low = glm::min(low, item.centre);
    high = glm::max(high, item.centre);
  }
  const glm::dvec3 extent = high - low;
  const auto bin_of = [&](const Item& item, int axis) {
    const double place = (item.centre[axis] - low[axis]) / extent[axis] * static_cast<double>(kBins);
    return std::min(static_cast<std::size_t>(place), kBins - 1);
  };

  double best_cost = kInfinity;
  int best_axis = 0;
  std::size_t best_bin = 0;  // the first of the second part
  for (int axis = 0; axis < 3 && !in_halves; ++axis) {
    if (!(extent[axis] > 0)) continue;
    std::array<Group, kBins> bins;
    for (const Item& item : items) bins[bin_of(item, axis)].add(item.box, 1);
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
    const auto second = std::partition(items.begin(), items.end(),
                                       [&](const Item& item) { return bin_of(item, best_axis) < best_bin; });
    const auto size = static_cast<std::size_t>(second - items.begin());
    if (size != 0 && size != items.size()) return size;
  }
  const int axis = extent.x >= std::max(extent.y, extent.z) ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::size_t half = items.size() / 2;
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                   [axis](const Item& a, const Item& b) {
                     return std::tie(a.centre[axis], a.id) < std::tie(b.centre[axis], b.id);
                   });
  return half;
}

}  // namespace

struct PatchTree::Builder {
  PatchTree& tree;
  std::span<Item> items;

  void build(std::size_t node, std::size_t first, std::size_t count, int depth) {
    const std::span<Item> own = items.subspan(first, count);
    Group group;
    for (const Item& item : own) group.add(item.box, 1);
    if (count <= kLeafSize) {
      tree.nodes_[node] = {group.box, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count)};
      return;
    }
    const std::size_t left = split(own, depth >= kMaxHeuristicDepth);
    const std::size_t children = tree.nodes_.size();
    tree.nodes_.resize(children + 2);
    tree.nodes_[node] = {group.box, static_cast<std::uint32_t>(children), 0};
    build(children, first, left, depth + 1);
    build(children + 1, first + left, count - left, depth + 1);
  }
};

PatchTree::PatchTree(const Scene& scene) : patches_(scene.patches) {
  if (patches_.empty()) return;
  std::vector<Item> items;
  items.reserve(patches_.size());
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    const Box box = bounds(corners(patches_[i].outline));
    items.push_back({box, 0.5 * (box.low + box.high), PatchId{static_cast<std::uint32_t>(i)}});
  }
  nodes_.resize(1);
  Builder{*this, items}.build(0, 0, items.size(), 0);
  ids_.reserve(items.size());
  for (const Item& item : items) ids_.push_back(item.id);
}

void PatchTree::candidates(const Shaft& shaft, double epsilon, std::vector<PatchId>& out) const {
  search([&](const Box& box) { return shaft.may_meet(box, epsilon); },
         [&](PatchId id) {
           if (may_meet(shaft, epsilon, id)) out.push_back(id);
           return false;
         });
}

void PatchTree::filter(const Shaft& shaft, double epsilon, std::span<const PatchId> among,
                       std::vector<PatchId>& out) const {
  std::ranges::copy_if(among, std::back_inserter(out),
                       [&](PatchId id) { return may_meet(shaft, epsilon, id); });
}

}  // namespace fluxel
