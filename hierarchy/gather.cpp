#include "hierarchy/gather.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/sampling.hpp"
#include "formfactor/free_segments.hpp"
#include "formfactor/view_factor.hpp"
#include "hierarchy/far_light.hpp"
#include "hierarchy/sender_places.hpp"

namespace fluxel {

namespace {

/// Senders whose variance over the squared distance is larger are taken with their outline.
constexpr double kFar = 0.04;

/// Where it is still larger, children of the sender take its place, as its radiosity varies.
constexpr double kNearParts = 0.08;

/// Where it is smaller than this the point rule will do.
constexpr double kPoint = 0.002;

constexpr std::size_t kMaxRays = 256;

/// A face is close where its variance is so many times the squared distance from it: neither its leaves nor
/// the unevenness of their light are small from there. What its radiosity may be off by is about this part of
/// it.
constexpr double kClose = 0.2, kUnknownShare = 0.05;

/// Faces that are darker count there as if this part of the mean radiosity fell on them.
constexpr double kLeastLight = 0.1;

/// Sums are in units of a largest irradiance. Beside a lamp that is brighter than the mean by more than this
/// they are in units of so many means: else what is small would be lost. They hold eight times as much.
constexpr double kBrightest = 0x1p30;

/// How many rays: by comparing pictures of stairs; errors that are asked for are measured afterwards.
constexpr double kRaysOfNoise = 0.2;

}  // namespace

double rays_a_spread(const GatherGoal& goal, double rho, double weight) {
  return rho * weight * weight *
         (kRaysOfNoise / (goal.error * goal.error * std::max(mean_of_colours(goal.mean_radiosity), 1e-300)));
}

Gatherer::Gatherer(const RayScene& ray_scene, const NodeTree& tree, const LinkTable& table,
                   std::span<const Rgb> B, std::span<const std::array<Rgb, 2>> slopes, const GatherGoal& goal)
    : ray_scene_(ray_scene), tree_(tree), table_(table), B_(B), slopes_(slopes), goal_(goal) {
  double largest = 0;
  for (const Rgb& value : B)
    largest = std::max({largest, std::abs(value.r), std::abs(value.g), std::abs(value.b)});
  if (const double mean = mean_of_colours(goal.mean_radiosity); mean > 0)
    largest = std::min(largest, kBrightest * mean);
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
  PointGather(const Gatherer& gatherer, const GatherPoint& point, std::uint32_t number, std::uint64_t part,
              std::vector<NearPlace>* near)
      : g_(gatherer),
        point_(point),
        number_(number),
        near_(near),
        normal_(gatherer.tree_[point.face].shape.normal),
        seed_(random_bits(random_bits(random_bits(gatherer.goal_.seed) + part) + number)),
        mean_(mean_of_colours(gatherer.goal_.mean_radiosity)),
        error_(gatherer.goal_.error / point.weight) {}

  void finish(std::uint64_t* out) {
    trace_single();
    for (std::size_t c = 0; c < kChannels; ++c) out[c] += static_cast<std::uint64_t>(sum_[c]);
  }

  [[nodiscard]] std::uint64_t rays() const { return rays_; }

  void add(const LinkEnd& end) {
    if (g_.tree_.is_cluster(end.from))
      add_cluster(end.from, static_cast<double>(end.F));
    else
      add_face(end.from, end.partial);
  }

 private:
  void add_face(NodeId from, bool partial) {
    const Sender& sender = g_.senders_[from];
    const glm::dvec3 d = sender.centroid - point_.position;
    const double r2 = glm::dot(d, d);
    if (sender.variance > kNearParts * r2 && !g_.tree_[from].is_leaf()) {
      for (const NodeId child : g_.tree_[from].child) add_face(child, partial);
      return;
    }
    const double height = glm::dot(normal_, d), other = -glm::dot(sender.normal, d);
    if (other <= 0) return;
    if (sender.variance > kFar * r2) {
      const double F = point_to_polygon(point_.position, normal_, corners(g_.tree_.outline(from)));
      if (near_ != nullptr && is_close(from)) choose_near_places(from, F, partial);
      const double chance = partial ? draw_chance(from, F) : 1;
      if (chance < 1 && random_number(from) >= chance) return;
      add_light_of(from, F, partial, chance);
    } else if (height > 0) {
      double F = sender.area * height * other / (std::numbers::pi * r2 * r2);
      const double chance = partial ? draw_chance(from, F) : 1;
      if (chance < 1 && random_number(from) >= chance) return;
      if (sender.variance > kPoint * r2)
        F = pair_form_factor(PairRule::moments, {point_.position, normal_, 0, {}}, g_.tree_[from].shape);
      add_light_of(from, F, partial, chance);
    }
  }

  [[nodiscard]] bool is_close(NodeId from) const {
    const Sender& sender = g_.senders_[from];
    return sender.variance >
           kClose * squared_distance(point_.position, corners(g_.tree_.outline(from)), sender.normal);
  }

  /// As many as rays for what the face's light may be off by, or by the same chance one.
  void choose_near_places(NodeId from, double F, bool partial) {
    const double rho = mean_of_colours(g_.tree_.material(from).rho);
    if (rho == 0) return;  // what it emits is known
    const double reflected = std::abs(mean_of_colours(g_.B_[from] - g_.sent(from, Rgb(0))));
    const Rgb unknown(F * kUnknownShare * std::max(reflected, kLeastLight * rho * mean_));
    const double share = share_of(unknown);
    if (!(share > 0)) return;
    const double chance = std::min(1.0, chance_of(share));
    if (chance < 1 && random_number(from, 1) >= chance) return;
    const auto count = static_cast<std::uint32_t>(
        std::ceil(std::min(wanted_rays(unknown), static_cast<double>(RayPacket::kSize))));
    const SenderPlaces places(g_.tree_, from, point_.position, normal_);
    std::array<SenderPlace, RayPacket::kSize> chosen;
    std::array<SurfaceSegment, RayPacket::kSize> segments;
    for (std::uint32_t k = 0; k < count; ++k) {
      constexpr std::uint64_t kSequence = 2;  // others are of rays
      const auto [u, v] = place(from, k, kSequence);
      chosen[k] = places.at(u, v);
      segments[k] = chosen[k].segment;
    }
    std::uint32_t free = ~0U;
    if (partial) {
      free = free_segments(g_.ray_scene_, std::span(segments).first(count));
      rays_ += count;
    }
    for (std::uint32_t k = 0; k < count; ++k) {
      if (!(chosen[k].F > 0) || (free >> k & 1u) == 0) continue;
      const double of_place = chosen[k].F / (count * chance);
      const glm::dvec3& at = segments[k].to;
      near_->push_back({number_,
                        k,
                        {g_.tree_.leaf_below(from, at), at, point_.weight * of_place * rho},
                        of_place,
                        partial ? radiosity_at(from, chosen[k]) : g_.B_[from]});
    }
  }

  /// `drawn`: the chance that this sender had to come so far.
  void add_light_of(NodeId from, double F, bool partial, double drawn = 1) {
    const Rgb light = F * g_.B_[from];
    if (light == Rgb(0)) return;
    if (!partial) {
      add_light(light);
      return;
    }
    const SenderPlaces places(g_.tree_, from, point_.position, normal_);
    const auto at = [&](std::size_t k, std::uint64_t sequence = 0) {
      const auto [u, v] = place(from, k, sequence);
      return places.at(u, v);
    };
    const double rays = wanted_rays(light);
    if (rays <= 1) {
      const SenderPlace first = at(0);
      if (first.F > 0) add_by_chance(from, first.segment, first.F * radiosity_at(from, first), drawn);
      return;
    }
    if (rays > RayPacket::kSize) {
      add_light(F * mean_seen(from, at, rays));
      return;
    }
    const double count = std::ceil(rays);
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
      const SenderPlace one = at(k);
      if (one.F > 0) add_single(one.segment, one.F / count * radiosity_at(from, one));
    }
  }

  /// Of the leaf there. Where a sender is lit in part, what hides the rest of it from the light mostly hides
  /// it from the point too: the mean would be too dark.
  [[nodiscard]] Rgb radiosity_at(NodeId from, const SenderPlace& place) const {
    const NodeId leaf = g_.tree_.leaf_below(from, place.segment.to);
    const glm::dvec2 at = g_.tree_.place(leaf, place.segment.to);
    return g_.B_[leaf] + at.x * g_.slopes_[leaf][0] + at.y * g_.slopes_[leaf][1];
  }

  /// What a contribution of this size is worth.
  [[nodiscard]] double wanted_rays(const Rgb& light) const {
    const double ratio = 0.5 * share_of(light) / error_;
    return ratio * std::cbrt(ratio);
  }

  [[nodiscard]] double share_of(const Rgb& light) const { return std::abs(mean_of_colours(light)) / mean_; }

  [[nodiscard]] double chance_of(double share) const { return share / (kSureShare * error_); }

  /// That a sender of about this form factor gets a ray, before more is known of it.
  [[nodiscard]] double draw_chance(NodeId from, double F) const {
    return std::min(1.0, kDrawnSurely * chance_of(share_of(F * g_.B_[from])));
  }

  /// Russian roulette (Arvo & Kirk 1990): of senders that hardly count a few stand for all.
  /// Both draws are by one random number, so that the smaller chance is the one that it had.
  void add_by_chance(NodeId from, const SurfaceSegment& segment, const Rgb& light, double drawn = 1) {
    const double chance = std::min(drawn, chance_of(share_of(light)));
    if (chance >= 1) {
      add_single(segment, light);
    } else if (random_number(from) < chance) {
      add_single(segment, light / chance);
    }
  }

  /// Some faces stand for all, more often near ones, and more of them the more light the link `F` brings.
  void add_cluster(NodeId from, double F) {
    // Mostly few of its faces emit.
    if (g_.goal_.light == LightFrom::emission && chance_of(share_of(F * g_.B_[from])) >= 1) {
      for (const NodeId child : g_.tree_[from].child) {
        if (g_.B_[child] == Rgb(0)) continue;
        if (g_.tree_.is_cluster(child)) {
          add_cluster(child, F * g_.senders_[child].area / g_.senders_[from].area);
        } else {
          add_face(child, true);
        }
      }
      return;
    }
    const double count = std::ceil(std::clamp<double>(wanted_rays(F * g_.B_[from]), 1, kMaxRays));
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) add_face_of(from, k, count);
  }

  void add_face_of(NodeId from, std::size_t k, double count) {
    auto [u, v] = place(from, k);
    const DrawnFace drawn = g_.tree_.draw_face(from, point_.position, u);
    const FlatShape& shape = g_.tree_[drawn.face].shape;
    if (glm::dot(shape.normal, point_.position - shape.centroid) <= 0) return;
    const SenderPlace one = SenderPlaces(g_.tree_, drawn.face, point_.position, normal_).at(u, v);
    if (!(one.F > 0)) return;
    const Rgb light = one.F / (drawn.chance * count) * radiosity_at(drawn.face, one);
    // The link says whether it counts; of many faces each is followed.
    count > 1 ? add_single(one.segment, light) : add_by_chance(from, one.segment, light);
  }

  void add_light(const Rgb& light) {
    constexpr double kMost = 0x1p53;
    for (int c = 0; c < kChannels; ++c)
      sum_[static_cast<std::size_t>(c)] += std::llrint(std::clamp(light[c] / g_.unit_, -kMost, kMost));
  }

  /// A place in the unit square that depends on the point, the sender, the sequence and the number alone
  /// (Roberts 2018: R2).
  [[nodiscard]] std::array<double, 2> place(NodeId from, std::size_t k, std::uint64_t sequence = 0) const {
    const std::uint64_t bits = random_bits((seed_ + sequence) ^ (std::uint64_t{from} * 0x9E3779B97F4A7C15u));
    const double u = static_cast<double>(bits >> 32) * 0x1p-32 + 0.7548776662466927 * static_cast<double>(k);
    const double v =
        static_cast<double>(bits & 0xFFFFFFFFu) * 0x1p-32 + 0.5698402909980532 * static_cast<double>(k);
    return {u - std::floor(u), v - std::floor(v)};
  }

  /// Of [0, 1), and nothing to do with the places.
  [[nodiscard]] double random_number(NodeId from, std::uint64_t sequence = 0) const {
    const std::uint64_t bits = (seed_ + sequence) ^ (std::uint64_t{from} * 0x9E3779B97F4A7C15u);
    return static_cast<double>(random_bits(~bits) >> 11) * 0x1p-53;
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

  /// The mean of what is seen of a sender, dark where it is hidden. A packet of pilot rays, no part of it,
  /// tells whether all are seen, or none, and one more will do (visible_fraction).
  template <class PlaceAt>
  Rgb mean_seen(NodeId from, const PlaceAt& at, double wanted) {
    SeenLight pilot;
    trace_packet(from, at, 0, 0, pilot);
    const bool agree = pilot.seen == 0 || pilot.seen == pilot.all;
    const auto most = agree ? RayPacket::kSize : static_cast<std::size_t>(std::min<double>(wanted, kMaxRays));
    SeenLight found;
    for (std::size_t rays = 0; rays < most; rays += RayPacket::kSize) trace_packet(from, at, 1, rays, found);
    return found.all > 0 ? found.light / found.all : Rgb(0);
  }

  struct SeenLight {
    double all = 0, seen = 0;  ///< sums of form factors
    Rgb light{0};
  };

  template <class PlaceAt>
  void trace_packet(NodeId from, const PlaceAt& at, std::uint64_t sequence, std::size_t first,
                    SeenLight& sum) {
    std::array<SurfaceSegment, RayPacket::kSize> segments;
    std::array<double, RayPacket::kSize> weight;
    std::array<Rgb, RayPacket::kSize> B;
    for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
      const SenderPlace one = at(first + k, sequence);
      segments[k] = one.segment;
      weight[k] = one.F;
      B[k] = radiosity_at(from, one);
    }
    const std::uint32_t free = free_segments(g_.ray_scene_, segments);
    for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
      sum.all += weight[k];
      if ((free >> k & 1u) == 0) continue;
      sum.seen += weight[k];
      sum.light += weight[k] * B[k];
    }
    rays_ += RayPacket::kSize;
  }

  /// Of a contribution, in errors: smaller ones get a ray by chance.
  static constexpr double kSureShare = 1;
  /// The point rule and the sender's mean, by which the draw is made first, are mostly right within this
  /// factor.
  static constexpr double kDrawnSurely = 2;

  const Gatherer& g_;
  const GatherPoint& point_;
  std::uint32_t number_;
  std::vector<NearPlace>* near_;
  glm::dvec3 normal_;
  std::uint64_t seed_;
  double mean_;
  double error_;  ///< of a single sender's light, over the mean
  std::array<std::int64_t, kChannels> sum_{};
  std::array<SurfaceSegment, RayPacket::kSize> segments_;
  std::array<Rgb, RayPacket::kSize> light_;
  std::size_t count_ = 0;
  std::uint64_t rays_ = 0;
};

std::uint64_t Gatherer::gather(std::span<const GatherPoint> points, std::span<const std::uint32_t> of_leaf,
                               std::uint64_t part, std::span<std::uint64_t> irradiance,
                               std::vector<NearPlace>* near) const {
  const Node& leaf = tree_[points[of_leaf[0]].face];
  PointGroup group;
  group.normal = leaf.shape.normal;
  group.count = of_leaf.size();
  std::vector<PointGather> singly;
  singly.reserve(of_leaf.size());
  for (std::size_t k = 0; k < of_leaf.size(); ++k) {
    const GatherPoint& point = points[of_leaf[k]];
    group.x[k] = point.position.x, group.y[k] = point.position.y, group.z[k] = point.position.z;
    singly.emplace_back(*this, point, of_leaf[k], part, near);
  }
  for (NodeId id = points[of_leaf[0]].face; id != kNoNode; id = tree_[id].parent) {
    for (const LinkEnd& end : table_.of(id)) {
      if (goal_.light == LightFrom::emission && B_[end.from] == Rgb(0)) continue;
      const Sender& sender = senders_[end.from];
      const double r = glm::distance(sender.centroid, leaf.shape.centroid) - leaf.radius;
      if (!end.partial && r > 0 && sender.variance <= kFar * r * r) {
        add_far_light(tree_[end.from].shape, B_[end.from], unit_, group);
      } else {
        for (PointGather& point : singly) point.add(end);
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
