// What a solution on links says of nodes and points: the rest of LinkHierarchy.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>
#include <tuple>

#include "core/sampling.hpp"
#include "hierarchy/far_light.hpp"
#include "hierarchy/link_hierarchy.hpp"
#include "hierarchy/ray_gather.hpp"

namespace fluxel {

namespace {

/// Of points that are gathered; places close to them, ten times as many and more, are kept for all at once.
constexpr std::size_t kPointsAtOnce = 4096;

/// That light is followed over between surfaces close to each other; beyond, it is as the solution has it.
constexpr int kMaxBounces = 4;

/// Numbers of points of one leaf.
using LeafPoints = std::vector<std::uint32_t>;

/// The points that have a leaf, in groups that can be gathered together.
std::vector<LeafPoints> group_by_leaf(std::span<const GatherPoint> points) {
  LeafPoints order;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (points[k].face != kNoNode) order.push_back(static_cast<std::uint32_t>(k));
  std::ranges::stable_sort(order, {}, [&](std::uint32_t k) { return points[k].face; });
  std::vector<LeafPoints> groups;
  for (const std::uint32_t k : order) {
    if (groups.empty() || groups.back().size() == PointGroup::kSize ||
        points[groups.back().front()].face != points[k].face)
      groups.emplace_back();
    groups.back().push_back(k);
  }
  return groups;
}

}  // namespace

void LinkHierarchy::find_first_light() {
  counts_.rays += first_light_.find(ranks_, threads_);
  leaves_.take(first_light_);
}

void LinkHierarchy::take_light(std::span<const Rgb> B, std::span<std::array<Rgb, 2>> slopes) {
  if (!first_light_.empty())
    for (std::size_t k = 0; k < slopes.size(); ++k)
      if (const NodeId leaf = leaves_.nodes()[k]; leaf != kNoNode)
        for (std::size_t axis = 0; axis < 2; ++axis) slopes[k][axis] += first_light_.of(leaf).slope[axis];
  light_ = light_of_nodes(tree_, leaves_, B, slopes);
  if (first_light_.empty()) return;
  for (const NodeId leaf : leaves_.nodes()) {
    if (leaf == kNoNode) continue;
    NodeLight& light = light_[leaf];
    light.deviation =
        std::hypot(light.deviation, light.rho * static_cast<float>(first_light_.of(leaf).residual));
  }
}

void LinkHierarchy::update_light(LinkOperator& F) {
  std::vector<std::array<Rgb, 2>> slopes(leaves_.unknowns().size());
  std::vector<Rgb> H(slopes.size());
  F.apply_with_slopes(radiosity_->B, H, slopes);
  take_light(radiosity_->B, slopes);
  slopes_.assign(tree_.size(), {Rgb(0), Rgb(0)});
  const std::vector<std::array<Rgb, 2>> of_leaves = slopes_of_leaves(tree_, leaves_, radiosity_->B, slopes);
  for (std::size_t k = 0; k < of_leaves.size(); ++k)
    if (const NodeId id = leaves_.nodes()[k]; id != kNoNode) slopes_[id] = of_leaves[k];
  const double unit = mean_ > 0 ? std::ldexp(1.0, std::ilogb(mean_) - 16) : 1.0;
  std::vector<std::uint64_t> residuals(tree_.size());
  add_squared_residuals(tree_, links_, light_, static_cast<double>(ray_scene_.surface_epsilon()), unit,
                        residuals);
  ranks_.sum(residuals);
  add_to_deviation(tree_, residuals, unit, light_);
  if (!oracle_.power) forget_power(mean_, light_);
}

std::vector<Rgb> LinkHierarchy::gathered_radiosity(LightFrom from) const {
  std::vector<Rgb> B(B_);
  if (from == LightFrom::everywhere && scale_ == Rgb(1)) return B;
  for (std::size_t k = tree_.clusters(); k < B.size(); ++k) {
    const Rgb E = tree_.emission(static_cast<NodeId>(k)), reflected = scale_ * (B[k] - E);
    B[k] = from == LightFrom::emission ? E : from == LightFrom::reflection ? reflected : E + reflected;
  }
  pull(tree_, std::span(B));
  return B;
}

std::vector<std::array<Rgb, 2>> LinkHierarchy::gathered_slopes(LightFrom from) const {
  std::vector<std::array<Rgb, 2>> slopes(slopes_);
  if (from == LightFrom::emission) slopes.assign(slopes.size(), {Rgb(0), Rgb(0)});
  for (std::array<Rgb, 2>& slope : slopes)
    for (Rgb& along : slope) along *= scale_;
  return slopes;
}

std::vector<Rgb> LinkHierarchy::gather(std::span<const GatherPoint> points, const GatherGoal& goal,
                                       Progress& progress) {
  const std::vector<Rgb> B = gathered_radiosity(goal.light);
  const std::vector<std::array<Rgb, 2>> slopes = gathered_slopes(goal.light);
  const Gatherer gatherer(ray_scene_, tree_, *table_, B, slopes, goal);
  // What goes on from places close by has come from everywhere.
  std::vector<Rgb> whole_B;
  std::optional<Gatherer> whole;
  if (goal.light == LightFrom::reflection) {
    whole_B = gathered_radiosity(LightFrom::everywhere);
    GatherGoal everywhere = goal;
    everywhere.light = LightFrom::everywhere;
    whole.emplace(ray_scene_, tree_, *table_, whole_B, slopes, everywhere);
  }
  const Gatherer& onwards = whole ? *whole : gatherer;
  std::uint64_t parts = 0;
  std::vector<Rgb> H;
  H.reserve(points.size());
  for (std::size_t first = 0; first < points.size(); first += kPointsAtOnce) {
    const std::span some = points.subspan(first, std::min(kPointsAtOnce, points.size() - first));
    std::vector<GatherPoint> on_leaves(some.begin(), some.end());
    for (GatherPoint& point : on_leaves) point.face = tree_.leaf_below(point.face, point.position);
    for (const Rgb& one : gather_some(gatherer, onwards, on_leaves, 0, parts)) H.push_back(one);
    progress.update(static_cast<double>(H.size()), static_cast<double>(points.size()));
  }
  return H;
}

std::array<std::vector<Rgb>, 2> LinkHierarchy::gather_halves(std::span<const GatherPoint> points,
                                                             const GatherGoal& goal, Progress& progress) {
  const auto half = [&](std::uint64_t number) {
    return gather(points,
                  {goal.error * std::sqrt(2.0), goal.mean_radiosity, 2 * goal.seed + number, goal.light},
                  progress);
  };
  return {half(0), half(1)};
}

/// By links, and of places close by what arrives there too, which is gathered in the same way: paths that go
/// on from surface to surface while the next one is nearby, as photon maps have it for one bounce (Jensen,
/// Realistic Image Synthesis Using Photon Mapping, 2001). `onwards` gathers at them; `bounces`: that paths
/// have had before these points; `parts`: gatherings so far, each of which has rays of its own.
std::vector<Rgb> LinkHierarchy::gather_some(const Gatherer& gatherer, const Gatherer& onwards,
                                            std::span<const GatherPoint> on_leaves, int bounces,
                                            std::uint64_t& parts) {
  if (bounces == kMaxBounces || gatherer.goal().light == LightFrom::emission)
    return gather_by_links(gatherer, on_leaves, parts++, nullptr);
  std::vector<NearPlace> near;
  std::vector<Rgb> H = gather_by_links(gatherer, on_leaves, parts++, &near);
  near = ranks_.gather(std::span<const NearPlace>(near));
  // Senders of a point have no leaf in common, so that all places differ by this.
  std::ranges::sort(
      near, {}, [](const NearPlace& place) { return std::tuple(place.point, place.at.face, place.number); });
  for (std::size_t first = 0; first < near.size(); first += kPointsAtOnce) {
    const std::span some = std::span(near).subspan(first, std::min(kPointsAtOnce, near.size() - first));
    std::vector<GatherPoint> places;
    places.reserve(some.size());
    for (const NearPlace& place : some) places.push_back(place.at);
    const std::vector<Rgb> there = gather_some(onwards, onwards, places, bounces + 1, parts);
    for (std::size_t k = 0; k < some.size(); ++k) {
      const NodeId leaf = some[k].at.face;
      H[some[k].point] += some[k].F * (gatherer.sent(leaf, there[k]) - some[k].B);
    }
  }
  return H;
}

/// `near`: gets the places of this rank's links that are close by.
std::vector<Rgb> LinkHierarchy::gather_by_links(const Gatherer& gatherer,
                                                std::span<const GatherPoint> on_leaves, std::uint64_t part,
                                                std::vector<NearPlace>* near) {
  const std::vector<LeafPoints> groups = group_by_leaf(on_leaves);
  std::vector<std::uint64_t> sums(kChannels * on_leaves.size());
  std::vector<std::vector<NearPlace>> near_groups(groups.size());
  std::atomic<std::uint64_t> rays = 0;
  tbb::task_arena arena(threads_);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, groups.size()), [&](const auto& range) {
      for (std::size_t k = range.begin(); k < range.end() && !is_stopped(); ++k)
        rays +=
            gatherer.gather(on_leaves, groups[k], part, sums, near == nullptr ? nullptr : &near_groups[k]);
    });
  });
  handle_signals();
  gather_rays_ += rays;
  ranks_.sum(sums);
  if (near != nullptr)
    for (const std::vector<NearPlace>& of_group : near_groups)
      near->insert(near->end(), of_group.begin(), of_group.end());
  std::vector<Rgb> H(on_leaves.size());
  for (std::size_t k = 0; k < H.size(); ++k)
    for (int c = 0; c < kChannels; ++c) {
      const std::uint64_t sum = sums[kChannels * k + static_cast<std::size_t>(c)];
      H[k][c] = gatherer.unit() * static_cast<double>(static_cast<std::int64_t>(sum));
    }
  if (luminaires_.empty() || gatherer.goal().light == LightFrom::reflection) return H;
  GatherGoal goal = gatherer.goal();
  goal.seed = random_bits(goal.seed) + part;
  const std::vector<Rgb> first = mean_of_halves(
      first_light_of_points(luminaires_, tree_, on_leaves, goal, ranks_, threads_, gather_rays_));
  for (std::size_t k = 0; k < H.size(); ++k) H[k] += first[k];
  return H;
}

}  // namespace fluxel
