#include "hierarchy/emitter_draw.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <span>

#include "core/sampling.hpp"
#include "formfactor/even_points.hpp"
#include "formfactor/free_segments.hpp"
#include "formfactor/view_factor.hpp"
#include "hierarchy/cluster_builder.hpp"

namespace fluxel {

namespace {

/// Of the scene's area: what a region has at most, if it is no single face.
constexpr double kRegionShare = 1.0 / 512;

/// Groups of emitters that are told apart; rays from each region to each of them, and pairs of points that
/// are looked at for that: not all face each other.
constexpr std::size_t kGroups = 16;
constexpr std::uint32_t kRays = RayPacket::kSize, kTries = 4 * kRays;

/// Variance of a face's points over the squared distance of its centroid: above it is near. Directions to
/// less of it are too close to each other to be told apart [sr].
constexpr double kNear = 0.02, kLeastSolidAngle = 1e-6;

/// Rays without an answer, half of them free: groups are mostly seen well or not at all (Beta distribution of
/// 0.1 and 0.1).
constexpr float kPriorRays = 0.1f;

/// The cosine of an angle less another one, of which sine and cosine are given; 1 where it is larger.
double cosine_within(double of, double sine, double cosine) {
  return of >= cosine ? 1 : of * cosine + std::sqrt(std::max(0.0, 1 - of * of)) * sine;
}

}  // namespace

EmitterDraw::EmitterDraw(const NodeTree& tree, const RayScene& ray_scene, int threads, const Ranks& ranks)
    : tree_(tree) {
  if (ranks.leads_host) build(ray_scene, threads);
  ranks.share(power_);
  ranks.share(cones_);
  ranks.share(region_);
  ranks.share(column_);
  ranks.share(seen_);
  std::vector columns{columns_};
  ranks.share(columns);
  columns_ = columns.front();
}

void EmitterDraw::build(const RayScene& ray_scene, int threads) {
  power_.resize(tree_.whole());
  cones_.resize(tree_.whole());
  region_.resize(tree_.whole());
  column_.assign(tree_.whole(), kNoColumn);
  for (std::size_t k = power_.size(); k-- > 0;) {
    const auto id = static_cast<NodeId>(k);
    if (tree_.is_cluster(id)) {
      const auto [a, b] = tree_[id].child;
      power_[k] = power_[a] + power_[b];
      cones_[k] = !(power_[a] > 0) ? cones_[b] : !(power_[b] > 0) ? cones_[a] : unite(cones_[a], cones_[b]);
    } else {
      power_[k] = mean_of_colours(glm::abs(tree_.emission(id))) * tree_[id].shape.area;
      cones_[k] = {tree_[id].shape.normal, 0};
    }
  }
  if (empty()) return;
  const std::vector<NodeId> groups = make_groups(), regions = make_regions();
  seen_.assign(regions.size() * columns_, 1);
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, regions.size(), [&](std::size_t region) {
      learn(ray_scene, groups, regions[region], std::span(seen_).subspan(region * columns_, columns_));
    });
  });
}

/// The strongest nodes are opened; those that are come first in the columns.
std::vector<NodeId> EmitterDraw::make_groups() {
  std::vector<NodeId> groups{0};
  const auto opens = [this](NodeId id) { return tree_.is_cluster(id) ? power_[id] : 0.0; };
  while (groups.size() < kGroups) {
    const auto strongest = std::ranges::max_element(groups, {}, opens);
    if (!(opens(*strongest) > 0)) break;
    const NodeId opened = *strongest;
    column_[opened] = static_cast<std::uint32_t>(columns_++);
    *strongest = tree_[opened].child[0];
    groups.push_back(tree_[opened].child[1]);
  }
  for (const NodeId id : groups) column_[id] = static_cast<std::uint32_t>(columns_++);
  return groups;
}

std::vector<NodeId> EmitterDraw::make_regions() {
  std::vector<NodeId> regions;
  // Parents come before their children.
  std::vector<bool> is_within(tree_.whole());
  for (NodeId id = 0; id < tree_.whole(); ++id) {
    const NodeId parent = tree_[id].parent;
    if (parent != kNoNode && is_within[parent]) {
      is_within[id] = true;
      region_[id] = region_[parent];
    } else if (!tree_.is_cluster(id) || tree_[id].shape.area <= kRegionShare * tree_[0].shape.area) {
      is_within[id] = true;
      region_[id] = static_cast<RegionId>(regions.size());
      regions.push_back(id);
    }
  }
  return regions;
}

void EmitterDraw::learn(const RayScene& ray_scene, std::span<const NodeId> groups, NodeId region,
                        std::span<float> seen) const {
  const auto drawn_from = [this](NodeId id, double choice) {
    while (tree_.is_cluster(id)) {
      const auto [a, b] = tree_[id].child;
      const double of_a = power_[a] / (power_[a] + power_[b]);
      const bool first = choice < of_a;
      choice = first ? choice / of_a : (choice - of_a) / (1 - of_a);
      id = first ? a : b;
    }
    return id;
  };
  for (const NodeId group : groups) {
    if (!(power_[group] > 0)) continue;
    SobolPoints points(random_bits(std::uint64_t{region} << 32 | group)),
        of_group(random_bits(~(std::uint64_t{region} << 32 | group)));
    std::array<SurfaceSegment, kRays> segments;
    std::uint32_t count = 0;
    for (std::uint32_t k = 0; k < kTries && count < kRays; ++k) {
      auto [which, u, v, lamp] = points.next();
      const auto [s, t, unused, other] = of_group.next();
      const NodeId face = tree_.random_face(region, which), emitter = drawn_from(group, lamp);
      const SurfaceSegment segment{surface_point(tree_.outline(face), u, v), tree_[face].shape.normal,
                                   surface_point(tree_.outline(emitter), s, t), tree_[emitter].shape.normal};
      const glm::dvec3 way = segment.to - segment.from;
      if (glm::dot(way, segment.from_normal) > 0 && glm::dot(way, segment.to_normal) < 0)
        segments[count++] = segment;
    }
    const auto free = static_cast<std::uint32_t>(
        count > 0 ? std::popcount(free_segments(ray_scene, std::span(segments).first(count))) : 0);
    seen[column_[group]] =
        std::sqrt((static_cast<float>(free) + kPriorRays) / (static_cast<float>(count) + 2 * kPriorRays));
  }
  // Of what is above the groups: the mean by power.
  const auto pull = [&](const auto& self, NodeId id) -> float {
    if (const auto [a, b] = tree_[id].child; column_[id] + groups.size() < columns_) {
      const auto part = static_cast<float>(power_[a] / power_[id]);
      seen[column_[id]] = part * self(self, a) + (1 - part) * self(self, b);
    }
    return seen[column_[id]];
  };
  pull(pull, 0);
}

RegionId EmitterDraw::region_of(NodeId face) const {
  while (face >= region_.size()) face = tree_[face].parent;
  return region_[face];
}

/// The largest product of the cosines at both ends of a segment from the point to what emits of the node, if
/// all of it emits (Conty Estevez & Kulla 2018); 0: none faces the other.
double EmitterDraw::most_facing(NodeId id, const ReceivingPoint& at) const {
  const glm::dvec3 d = tree_[id].shape.centroid - at.position;
  const double distance = glm::length(d), radius = tree_[id].radius;
  if (distance <= radius) return 1;
  const glm::dvec3 way = d / distance;
  // Of the cone of directions in which the node lies.
  const double sine = radius / distance, cosine = std::sqrt(1 - sine * sine);
  const double in = cosine_within(glm::dot(at.normal, way), sine, cosine);
  if (in <= 0) return 0;
  const Cone& cone = cones_[id];
  const double around = cone.half_angle + std::asin(sine);
  if (around >= std::numbers::pi) return in;
  const double out = cosine_within(-glm::dot(cone.axis, way), std::sin(around), std::cos(around));
  return in * std::max(0.0, out);
}

double EmitterDraw::seen_from(NodeId id, RegionId region) const {
  const std::uint32_t column = column_[id];
  return column == kNoColumn ? 1.0 : static_cast<double>(seen_[region * columns_ + column]);
}

/// Of the two's choice. Nearer than half its radius a node is taken to be that far away.
double EmitterDraw::share(NodeId child, NodeId sibling, const ReceivingPoint& at) const {
  const auto weight = [&](NodeId id) {
    const glm::dvec3 d = tree_[id].shape.centroid - at.position;
    const double reach = 0.5 * tree_[id].radius;
    return seen_from(id, at.region) * power_[id] / std::max(glm::dot(d, d), reach * reach);
  };
  if (!(power_[sibling] > 0)) return 1;
  if (!(power_[child] > 0)) return 0;
  const double facing = most_facing(child, at), other = most_facing(sibling, at);
  // Where nothing faces the point any will do.
  if (facing == 0 && other == 0) return 0.5;
  const double of_child = facing * weight(child);
  return of_child / (of_child + other * weight(sibling));
}

/// What reaches the point, about as a form factor has it, times the root of how much of it is seen from
/// around there: of a face if nothing stands before it, of a cluster if all of it faces the point [W/m2].
double EmitterDraw::apparent_power(NodeId id, const ReceivingPoint& at) const {
  NodeId group = id;
  while (column_[group] == kNoColumn) group = tree_[group].parent;
  const double seen = seen_from(group, at.region);
  const FlatShape& shape = tree_[id].shape;
  const glm::dvec3 d = shape.centroid - at.position;
  const double squared = glm::dot(d, d);
  if (tree_.is_cluster(id)) {
    const double reach = 0.5 * tree_[id].radius;
    return seen * most_facing(id, at) * power_[id] / (std::numbers::pi * std::max(squared, reach * reach));
  }
  if (glm::dot(shape.normal, d) >= 0) return 0;
  // Of one that rises above the point's horizon its centroid does not tell.
  const bool is_cut = std::abs(glm::dot(at.normal, d)) < tree_[id].radius;
  if (is_cut || shape.moments.trace() >= kNear * squared)
    return seen * power_[id] / shape.area *
           point_to_polygon(at.position, at.normal, corners(tree_.outline(id)));
  return seen * power_[id] * std::max(0.0, glm::dot(at.normal, d)) * -glm::dot(shape.normal, d) /
         (std::numbers::pi * squared * squared);
}

DrawnEmitter EmitterDraw::draw(const ReceivingPoint& at, double choice, double u, double v) const {
  return draw_below(0, 1, at, choice, u, v);
}

/// `chance` of the node.
DrawnEmitter EmitterDraw::draw_below(NodeId id, double chance, const ReceivingPoint& at, double choice,
                                     double u, double v) const {
  while (tree_.is_cluster(id)) {
    const auto [a, b] = tree_[id].child;
    const double of_a = share(a, b, at);
    const bool first = choice < of_a;
    choice = first ? choice / of_a : (choice - of_a) / (1 - of_a);
    chance *= first ? of_a : 1 - of_a;
    id = first ? a : b;
  }
  const std::optional<SeenFace> near = as_near(id, at.position);
  const glm::dvec3 point = near ? near->draw(u, v) : surface_point(tree_.outline(id), u, v);
  return {id, point, chance * density_on(id, near, point, at.position)};
}

/// Where points of equal areas would count very differently.
std::optional<SeenFace> EmitterDraw::as_near(NodeId face, const glm::dvec3& from) const {
  const FlatShape& shape = tree_[face].shape;
  const glm::dvec3 d = shape.centroid - from;
  if (shape.moments.trace() < kNear * glm::dot(d, d)) return std::nullopt;
  const SeenFace seen(tree_.outline(face), from);
  return seen.solid_angle() > kLeastSolidAngle ? std::optional(seen) : std::nullopt;
}

/// With a chance of 1 for the face [1/m2].
double EmitterDraw::density_on(NodeId face, const std::optional<SeenFace>& near, const glm::dvec3& of,
                               const glm::dvec3& from) const {
  if (!near) return 1 / tree_[face].shape.area;
  const glm::dvec3 way = of - from;
  const double squared = glm::dot(way, way);
  return std::abs(glm::dot(way, tree_[face].shape.normal)) /
         (squared * std::sqrt(squared) * near->solid_angle());
}

double EmitterDraw::density(NodeId face, const glm::dvec3& of, const ReceivingPoint& at) const {
  return chance(face, at) * density_on(face, as_near(face, at.position), of, at.position);
}

double EmitterDraw::chance(NodeId face, const ReceivingPoint& at) const {
  double chance = 1;
  for (NodeId id = face; tree_[id].parent != kNoNode; id = tree_[id].parent) {
    const auto [a, b] = tree_[tree_[id].parent].child;
    chance *= share(id, id == a ? b : a, at);
  }
  return chance;
}

}  // namespace fluxel
