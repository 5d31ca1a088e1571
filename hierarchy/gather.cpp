#include "hierarchy/gather.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/sampling.hpp"
#include "formfactor/free_segments.hpp"
#include "formfactor/view_factor.hpp"

namespace fluxel {

namespace {

/// Senders whose variance over the squared distance is larger are taken with their outline.
constexpr double kFar = 0.02;

/// The same for senders that vary: their children are taken.
constexpr double kNearParts = 0.05;

constexpr std::size_t kMostRays = 256;

double mean_of_colours(const Rgb& x) { return (x.r + x.g + x.b) / kChannels; }

}  // namespace

Gatherer::Gatherer(const RayScene& ray_scene, const NodeTree& tree, const LinkTable& links,
                   std::span<const Rgb> B, const GatherGoal& goal)
    : ray_scene_(ray_scene), tree_(tree), links_(links), B_(B), goal_(goal) {
  double largest = 0;
  for (const Rgb& value : B)
    largest = std::max({largest, std::abs(value.r), std::abs(value.g), std::abs(value.b)});
  if (largest > 0) unit_ = std::ldexp(1.0, std::ilogb(largest) - 52);
}

/// The light of one point.
class Gatherer::PointGather {
 public:
  PointGather(const Gatherer& gatherer, const GatherPoint& point, std::uint64_t seed)
      : g_(gatherer),
        point_(point),
        normal_(gatherer.tree_[point.face].shape.normal),
        seed_(random_bits(seed ^ gatherer.goal_.seed << 48)),
        mean_(mean_of_colours(gatherer.goal_.mean_radiosity)) {}

  void add_node(NodeId id) {
    for (const Link& link : g_.links_.of(id)) add(link.from, link.partial);
  }

  void finish(std::uint64_t* out) {
    trace_single();
    for (std::size_t c = 0; c < kChannels; ++c) out[c] += static_cast<std::uint64_t>(sum_[c]);
  }

  [[nodiscard]] std::uint64_t rays() const { return rays_; }

 private:
  void add(NodeId from, bool partial) {
    if (g_.tree_.is_cluster(from)) {
      add_cluster(from);
      return;
    }
    const Node& sender = g_.tree_[from];
    const glm::dvec3 d = sender.shape.centroid - point_.position;
    const double r2 = glm::dot(d, d), variance = sender.shape.moments.trace();
    if (variance > kNearParts * r2 && !sender.is_leaf()) {
      add(sender.child[0], partial);
      add(sender.child[1], partial);
      return;
    }
    double F;
    if (variance > kFar * r2) {
      const double below = glm::dot(sender.shape.normal, point_.position - sender.shape.centroid);
      if (below <= 0) return;
      F = point_to_polygon(point_.position, normal_, corners(g_.tree_.outline(from)));
    } else {
      const double height = glm::dot(normal_, d), other = -glm::dot(sender.shape.normal, d);
      if (height <= 0 || other <= 0) return;
      const FlatShape here{point_.position, normal_, 0, {}};
      F = pair_form_factor(PairRule::moments, here, sender.shape);
    }
    if (!(F > 0)) return;
    const Rgb light = F * g_.B_[from];
    if (!partial) {
      add_light(light);
      return;
    }
    const double share = mean_of_colours(light) / mean_;
    const double chance = share / (kSureShare * g_.goal_.error);
    if (chance < 1) {
      // Russian roulette (Arvo & Kirk 1990): of senders that hardly count a few stand for all.
      if (place(from, 1)[0] < chance) add_single(segment_to(from, 0), light / chance);
    } else if (share <= kSingleShare * g_.goal_.error) {
      add_single(segment_to(from, 0), light);
    } else {
      add_light(visible(from, share) * light);
    }
  }

  /// One random face stands for all.
  void add_cluster(NodeId from) {
    auto [u, v] = place(from, 0);
    const NodeId face = g_.tree_.random_face(from, u);
    const FlatShape& sender = g_.tree_[face].shape;
    const SurfaceSegment segment{point_.position, normal_, surface_point(g_.tree_.outline(face), u, v),
                                 sender.normal};
    const glm::dvec3 d = segment.to - segment.from;
    const double r2 = glm::dot(d, d), height = glm::dot(normal_, d), other = -glm::dot(sender.normal, d);
    if (height > 0 && other > 0)
      add_single(segment, g_.tree_[from].shape.area * height * other /
                              (r2 * (std::numbers::pi * r2 + sender.area)) * g_.B_[face]);
  }

  void add_light(const Rgb& light) {
    for (int c = 0; c < kChannels; ++c) sum_[static_cast<std::size_t>(c)] += std::llrint(light[c] / g_.unit_);
  }

  /// A place in the unit square that depends on the point, the sender and the number alone (Roberts 2018:
  /// R2).
  [[nodiscard]] std::array<double, 2> place(NodeId from, std::size_t k) const {
    const std::uint64_t bits = random_bits(seed_ ^ (std::uint64_t{from} * 0x9E3779B97F4A7C15u));
    const double u = static_cast<double>(bits >> 32) * 0x1p-32 + 0.7548776662466927 * static_cast<double>(k);
    const double v =
        static_cast<double>(bits & 0xFFFFFFFFu) * 0x1p-32 + 0.5698402909980532 * static_cast<double>(k);
    return {u - std::floor(u), v - std::floor(v)};
  }

  [[nodiscard]] SurfaceSegment segment_to(NodeId from, std::size_t k) const {
    const auto [u, v] = place(from, k);
    return {point_.position, normal_, surface_point(g_.tree_.outline(from), u, v),
            g_.tree_[from].shape.normal};
  }

  void add_single(const SurfaceSegment& segment, const Rgb& light) {
    segments_[count_] = segment;
    light_[count_] = light;
    if (++count_ == RayPacket::kSize) trace_single();
  }

  void trace_single() {
    if (count_ == 0) return;
    const std::uint32_t free = free_segments(g_.ray_scene_, std::span(segments_).first(count_));
    for (std::size_t k = 0; k < count_; ++k)
      if ((free >> k & 1u) != 0) add_light(light_[k]);
    rays_ += count_;
    count_ = 0;
  }

  /// Packets of rays until they have settled it.
  double visible(NodeId from, double share) {
    const FlatShape& sender = g_.tree_[from].shape;
    double all = 0, seen = 0;
    const double wanted = std::pow(0.5 * share / g_.goal_.error, 4.0 / 3);
    const auto most = static_cast<std::size_t>(std::min<double>(wanted, kMostRays));
    std::size_t rays = 0;
    do {
      std::array<SurfaceSegment, RayPacket::kSize> segments;
      std::array<double, RayPacket::kSize> weight;
      for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
        segments[k] = segment_to(from, rays + k);
        const glm::dvec3 d = segments[k].to - point_.position;
        const double r2 = glm::dot(d, d);
        weight[k] =
            std::max(0.0, glm::dot(normal_, d)) * std::max(0.0, -glm::dot(sender.normal, d)) / (r2 * r2);
      }
      const std::uint32_t free = free_segments(g_.ray_scene_, segments);
      for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
        all += weight[k];
        if ((free >> k & 1u) != 0) seen += weight[k];
      }
      rays += RayPacket::kSize;
    } while (rays < most && seen > 0 && seen < all);
    rays_ += rays;
    return all > 0 ? seen / all : 0;
  }

  /// Smaller contributions, in errors, get one ray.
  static constexpr double kSingleShare = 4;
  /// Still smaller ones get it by chance.
  static constexpr double kSureShare = 0.5;

  const Gatherer& g_;
  const GatherPoint& point_;
  glm::dvec3 normal_;
  std::uint64_t seed_;
  double mean_;
  std::array<std::int64_t, kChannels> sum_{};
  std::array<SurfaceSegment, RayPacket::kSize> segments_;
  std::array<Rgb, RayPacket::kSize> light_;
  std::size_t count_ = 0;
  std::uint64_t rays_ = 0;
};

std::uint64_t Gatherer::gather(std::span<const GatherPoint> points, std::uint64_t first_seed,
                               std::span<std::uint64_t> irradiance) const {
  std::uint64_t rays = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (points[k].face == kNoNode) continue;
    PointGather gather(*this, points[k], first_seed + k);
    for (NodeId id = points[k].face; id != kNoNode; id = tree_[id].parent) gather.add_node(id);
    gather.finish(&irradiance[kChannels * k]);
    rays += gather.rays();
  }
  return rays;
}

}  // namespace fluxel
