#include "hierarchy/gather.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>

#include "core/sampling.hpp"
#include "formfactor/free_segments.hpp"
#include "formfactor/seen_polygon.hpp"
#include "formfactor/view_factor.hpp"
#include "hierarchy/far_light.hpp"

namespace fluxel {

namespace {

/// Senders whose variance over the squared distance is larger are taken with their outline.
constexpr double kFar = 0.04;

/// Where it is still larger, children of the sender take its place, as its radiosity varies.
constexpr double kNearParts = 0.08;

/// Where it is smaller than this the point rule will do.
constexpr double kPoint = 0.002;

constexpr std::size_t kMostRays = 256;

}  // namespace

Gatherer::Gatherer(const RayScene& ray_scene, const NodeTree& tree, const LinkTable& links,
                   std::span<const Rgb> B, const GatherGoal& goal)
    : ray_scene_(ray_scene), tree_(tree), links_(links), B_(B), goal_(goal) {
  double largest = 0;
  for (const Rgb& value : B)
    largest = std::max({largest, std::abs(value.r), std::abs(value.g), std::abs(value.b)});
  if (largest > 0) unit_ = std::ldexp(1.0, std::ilogb(largest) - 49);
  senders_.reserve(tree.size());
  for (std::size_t id = 0; id < tree.size(); ++id) {
    const FlatShape& shape = tree[static_cast<NodeId>(id)].shape;
    senders_.push_back({shape.centroid, shape.normal, shape.area, shape.moments.trace()});
  }
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

  void finish(std::uint64_t* out) {
    trace_single();
    for (std::size_t c = 0; c < kChannels; ++c) out[c] += static_cast<std::uint64_t>(sum_[c]);
  }

  [[nodiscard]] std::uint64_t rays() const { return rays_; }

  void add(NodeId from, bool partial) {
    if (g_.tree_.is_cluster(from)) {
      add_cluster(from);
      return;
    }
    const Sender& sender = g_.senders_[from];
    const glm::dvec3 d = sender.centroid - point_.position;
    const double r2 = glm::dot(d, d);
    if (sender.variance > kNearParts * r2 && !g_.tree_[from].is_leaf()) {
      for (const NodeId child : g_.tree_[from].child) add(child, partial);
      return;
    }
    const double height = glm::dot(normal_, d), other = -glm::dot(sender.normal, d);
    if (other <= 0) return;
    if (sender.variance > kFar * r2) {
      add_light_of(from, point_to_polygon(point_.position, normal_, corners(g_.tree_.outline(from))),
                   partial);
    } else if (height > 0) {
      double F = sender.area * height * other / (std::numbers::pi * r2 * r2);
      if (partial && !is_drawn(from, F)) return;
      if (sender.variance > kPoint * r2)
        F = pair_form_factor(PairRule::moments, {point_.position, normal_, 0, {}}, g_.tree_[from].shape);
      add_light_of(from, F, partial);
    }
  }

 private:
  void add_light_of(NodeId from, double F, bool partial) {
    const Rgb light = F * g_.B_[from];
    if (light == Rgb(0)) return;
    if (!partial) {
      add_light(light);
      return;
    }
    const Places places(*this, from);
    const double ratio = 0.5 * share_of(light) / g_.goal_.error;
    if (ratio <= 1) {
      const Place place = places[0];
      if (place.F > 0) add_by_chance(from, place.segment, place.F * g_.B_[from]);
      return;
    }
    const double rays = ratio * std::cbrt(ratio);
    if (rays > RayPacket::kSize) {
      add_light(visible(places, rays) * light);
      return;
    }
    const double count = std::ceil(rays);
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
      const Place place = places[k];
      if (place.F > 0) add_single(place.segment, place.F / count * g_.B_[from]);
    }
  }

  /// A place of a sender, and the form factor that it stands for: that of the sender is the mean of all.
  struct Place {
    SurfaceSegment segment;
    double F = 0;
  };

  /// The places that rays go to. Of a near sender a small part may bring most of the light, and where places
  /// are drawn alike over the area few of them would be there: they are drawn by their directions.
  class Places {
   public:
    Places(const PointGather& gather, NodeId from)
        : gather_(gather),
          from_(from),
          outline_(gather.g_.tree_.outline(from)),
          sender_(gather.g_.senders_[from]) {
      const glm::dvec3 d = sender_.centroid - gather.point_.position;
      if (sender_.variance > kFar * glm::dot(d, d))
        seen_.emplace(gather.point_.position, corners(outline_), sender_.normal);
    }

    Place operator[](std::size_t k) const {
      const auto [u, v] = gather_.place(from_, k);
      const glm::dvec3& here = gather_.point_.position;
      Place place{{here, gather_.normal_, seen_ ? seen_->point(u, v) : surface_point(outline_, u, v),
                   sender_.normal}};
      const glm::dvec3 d = place.segment.to - here;
      const double r2 = glm::dot(d, d), height = std::max(0.0, glm::dot(gather_.normal_, d));
      const double solid_angle =
          seen_ ? seen_->solid_angle() : -sender_.area * glm::dot(sender_.normal, d) / (r2 * std::sqrt(r2));
      place.F = r2 > 0 ? solid_angle * height / (std::numbers::pi * std::sqrt(r2)) : 0.0;
      return place;
    }

   private:
    const PointGather& gather_;
    NodeId from_;
    const Outline<glm::dvec3>& outline_;
    const Sender& sender_;
    std::optional<SeenPolygon> seen_;
  };

  [[nodiscard]] double share_of(const Rgb& light) const { return std::abs(mean_of_colours(light)) / mean_; }

  [[nodiscard]] double chance_of(double share) const { return share / (kSureShare * g_.goal_.error); }

  /// Whether a sender of about this form factor gets a ray.
  [[nodiscard]] bool is_drawn(NodeId from, double F) const {
    const double chance = kDrawnSurely * chance_of(share_of(F * g_.B_[from]));
    return chance >= 1 || lot(from) < chance;
  }

  /// Russian roulette (Arvo & Kirk 1990): of senders that hardly count a few stand for all.
  void add_by_chance(NodeId from, const SurfaceSegment& segment, const Rgb& light) {
    const double chance = chance_of(share_of(light));
    if (chance >= 1) {
      add_single(segment, light);
    } else if (lot(from) < chance) {
      add_single(segment, light / chance);
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
    if (height <= 0 || other <= 0) return;
    const double F = g_.tree_[from].shape.area * height * other /
                     (r2 * (std::numbers::pi * r2 + kNearestPoints * sender.area));
    add_by_chance(from, segment, F * g_.B_[face]);
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

  /// Of [0, 1), and nothing to do with the places.
  [[nodiscard]] double lot(NodeId from) const {
    return static_cast<double>(random_bits(~(seed_ ^ (std::uint64_t{from} * 0x9E3779B97F4A7C15u))) >> 11) *
           0x1p-53;
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
  double visible(const Places& places, double wanted) {
    double all = 0, seen = 0;
    const auto most = static_cast<std::size_t>(std::min<double>(wanted, kMostRays));
    std::size_t rays = 0;
    do {
      std::array<SurfaceSegment, RayPacket::kSize> segments;
      std::array<double, RayPacket::kSize> weight;
      for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
        const Place place = places[rays + k];
        segments[k] = place.segment;
        weight[k] = place.F;
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

  /// Of a contribution, in errors: smaller ones get a ray by chance.
  static constexpr double kSureShare = 1;
  /// The point rule, by which the draw is made first, is right within this factor.
  static constexpr double kDrawnSurely = 2;

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

std::uint64_t Gatherer::gather(std::span<const GatherPoint> points, std::span<const std::uint32_t> of_leaf,
                               std::span<std::uint64_t> irradiance) const {
  const Node& leaf = tree_[points[of_leaf[0]].face];
  PointGroup group;
  group.normal = leaf.shape.normal;
  group.count = of_leaf.size();
  std::vector<PointGather> singly;
  singly.reserve(of_leaf.size());
  for (std::size_t k = 0; k < of_leaf.size(); ++k) {
    const GatherPoint& point = points[of_leaf[k]];
    group.x[k] = point.position.x, group.y[k] = point.position.y, group.z[k] = point.position.z;
    singly.emplace_back(*this, point, of_leaf[k]);
  }
  for (NodeId id = points[of_leaf[0]].face; id != kNoNode; id = tree_[id].parent) {
    for (const Link& link : links_.of(id)) {
      const Sender& sender = senders_[link.from];
      const double r = glm::distance(sender.centroid, leaf.shape.centroid) - leaf.radius;
      if (!link.partial && r > 0 && sender.variance <= kFar * r * r) {
        add_far_light(tree_[link.from].shape, B_[link.from], unit_, group);
      } else {
        for (PointGather& point : singly) point.add(link.from, link.partial);
      }
    }
  }
  std::uint64_t rays = 0;
  for (std::size_t k = 0; k < of_leaf.size(); ++k) {
    std::uint64_t* sums = &irradiance[kChannels * of_leaf[k]];
    singly[k].finish(sums);
    const std::array<double, kChannels> far{group.red[k], group.green[k], group.blue[k]};
    for (std::size_t c = 0; c < kChannels; ++c)
      sums[c] += static_cast<std::uint64_t>(std::llrint(far[c] / unit_));
    rays += singly[k].rays();
  }
  return rays;
}

}  // namespace fluxel
