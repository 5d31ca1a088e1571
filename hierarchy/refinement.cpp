#include "hierarchy/refinement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/sampling.hpp"
#include "formfactor/even_points.hpp"
#include "formfactor/exchange.hpp"
#include "hierarchy/face_pair.hpp"
#include "hierarchy/seen_slope.hpp"
#include "hierarchy/sender_places.hpp"
#include "visibility/find_occluders.hpp"

namespace fluxel {

namespace {

/// Packets of rays between clusters that meet; others get one.
constexpr int kPacketsOfMeeting = 4;

/// Of the smaller face's area: that a form factor may err by where no light needs it better, for row sums,
/// and what is made of them, are of all form factors alike.
constexpr double kWorstFormFactor = 0.02;

/// More patches in a shaft are not told apart.
constexpr std::size_t kMaxInShaft = 64;
/// So few are looked at closely.
constexpr std::size_t kFewInShaft = 16;

Slope packed(const glm::dvec2& slope) {
  // Towards nothing, so that what is nowhere negative stays so.
  return {static_cast<std::int8_t>(kSlopeOne * slope.x), static_cast<std::int8_t>(kSlopeOne * slope.y)};
}

SampledPolygon polygon_of(const NodeTree& tree, NodeId id, const FlatShape& other, double epsilon) {
  return {clip_to_front(corners(tree.outline(id)), {other.centroid, other.normal}, epsilon),
          tree[id].shape.normal};
}

}  // namespace

RefinementCounts& RefinementCounts::operator+=(const RefinementCounts& other) {
  pairs += other.pairs;
  shafts += other.shafts;
  contours += other.contours;
  rays += other.rays;
  return *this;
}

/// The way down from one pair.
class Refiner::Descent {
 public:
  Descent(const Refiner& refiner, std::span<const NodeLight> light, const RefinementGoal& goal,
          std::size_t visits, RefinedPairs& result)
      : refiner_(refiner),
        tree_(refiner.tree_),
        oracle_(refiner.oracle(light, goal)),
        settle_(goal.settle),
        visits_(visits),
        result_(result),
        epsilon_(refiner.epsilon()) {}

  void visit(NodeId p, NodeId q, bool free) {
    if (visits_ == 0) {
      result_.pending.push_back({{p, q}, free});
      return;
    }
    --visits_;
    ++result_.counts.pairs;
    if (p == q) {
      visit_within(p);
    } else if (tree_.is_cluster(p) || tree_.is_cluster(q)) {
      visit_clusters(p, q);
    } else {
      visit_faces(p, q, free);
    }
  }

 private:
  void visit_within(NodeId p) {
    if (!tree_.is_cluster(p)) return;
    if (settle_ || oracle_.cluster_error(p, p) <= 1) {
      accept_clusters(p, p);
      return;
    }
    const auto [a, b] = tree_[p].child;
    visit(a, a, false);
    visit(a, b, false);
    visit(b, b, false);
  }

  /// Nodes of which one at least is a cluster.
  void visit_clusters(NodeId p, NodeId q) {
    if (!may_face(tree_, p, q, epsilon_)) return;
    if (settle_ || oracle_.cluster_error(p, q) <= 1) {
      accept_clusters(p, q);
    } else {
      split_cluster(p, q);
    }
  }

  /// By rays between random points, so that links err independently. Where clusters meet a few near points
  /// carry most of it, and more are asked.
  void accept_clusters(NodeId p, NodeId q) {
    const int packets = meet(p, q) ? kPacketsOfMeeting : 1;
    const double of_p = tree_[p].shape.area, of_q = tree_[q].shape.area;
    const NodeId small = of_p <= of_q ? p : q, large = small == p ? q : p;
    SobolPoints places(std::uint64_t{p} << 32 | q);
    double sum = 0;
    for (int packet = 0; packet < packets; ++packet) sum += visible_form_factors(small, large, places);
    const double G = std::min(of_p, of_q) * std::min(1.0, sum / (packets * RayPacket::kSize));
    result_.links.push_back({p, q, static_cast<float>(G), 0, {}, {}, true});
  }

  [[nodiscard]] bool meet(NodeId p, NodeId q) const {
    const double reach = tree_[p].radius + tree_[q].radius;
    return glm::distance(tree_[p].shape.centroid, tree_[q].shape.centroid) <= reach;
  }

  /// The sum of the form factors towards q at a packet of random points of p, what stands between taken off.
  double visible_form_factors(NodeId p, NodeId q, SobolPoints& places) {
    std::array<SurfaceSegment, RayPacket::kSize> segments;
    std::array<double, RayPacket::kSize> F;
    std::size_t count = 0;
    for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
      auto [u, v, s, t] = places.next();
      const NodeId from = tree_.random_face(p, u);
      const glm::dvec3 point = surface_point(tree_.outline(from), u, v);
      const DrawnFace to = tree_.draw_face(q, point, s);
      const FlatShape& there = tree_[to.face].shape;
      if (glm::dot(there.normal, point - there.centroid) <= epsilon_) continue;
      const glm::dvec3& normal = tree_[from].shape.normal;
      const SenderPlace place = SenderPlaces(tree_, to.face, point, normal).at(s, t);
      if (glm::dot(normal, place.segment.to - point) <= epsilon_) continue;
      segments[count] = place.segment;
      F[count++] = place.F / to.chance;
    }
    const std::uint32_t free = free_segments(refiner_.ray_scene_, std::span(segments).first(count));
    result_.counts.rays += count;
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k)
      if ((free >> k & 1u) != 0) sum += F[k];
    return sum;
  }

  void split_cluster(NodeId p, NodeId q) {
    const bool split_p = tree_.is_cluster(p) && (!tree_.is_cluster(q) || tree_[p].radius >= tree_[q].radius);
    const NodeId whole = split_p ? p : q, other = split_p ? q : p;
    for (const NodeId child : tree_[whole].child) visit(child, other, false);
  }

  void visit_faces(NodeId p, NodeId q, bool free) {
    free = free || tree_.scene().statistics.convex;
    const FacePair pair = estimate_face_pair(tree_, p, q, epsilon_);
    if (!pair.facing) return;
    LinkErrors error = oracle_.errors(p, q, pair, !free);
    // What hardly counts is not worth a shaft: rays alone tell what they see of each other.
    constexpr double kNotWorth = 0.02;
    if (!free && error.sum() <= kNotWorth) {
      accept(p, q, pair, false);
      return;
    }
    if (!free) {
      const Between between = occlusion_between(p, q);
      if (between == Between::blocked) return;
      free = between == Between::nothing;
      if (free) error.by_shadow = 0;
    }
    const Halving next = oracle_.to_halve(p, q, pair, error);
    if (settle_ || oracle_.is_settled(next, error)) {
      accept(p, q, pair, free);
    } else {
      split_face({next, weight_of(error)}, next.leaf == p ? q : p, free);
    }
  }

  /// By how much too much it is, as far as that matters.
  static std::uint64_t weight_of(const LinkErrors& error) {
    return static_cast<std::uint64_t>(16 * std::min(error.sum(), 1e3));
  }

  void split_face(const WantedHalving& wanted, NodeId other, bool free) {
    const NodeId whole = wanted.halving.leaf;
    if (tree_[whole].is_leaf()) {
      result_.wanted.push_back(wanted);
      result_.open.push_back({whole, other});
      return;
    }
    for (const NodeId child : tree_[whole].child) visit(child, other, free);
  }

  enum class Between { nothing, something, blocked };

  [[nodiscard]] Between occlusion_between(NodeId p, NodeId q) {
    ++result_.counts.shafts;
    const Shaft shaft(corners(tree_.outline(p)), corners(tree_.outline(q)));
    const Scene& scene = tree_.scene();
    if (!find_occluders(refiner_.patch_tree_, refiner_.occluders_, shaft, static_cast<float>(scene.extent),
                        kMaxInShaft, ids_))
      return Between::something;
    if (ids_.size() <= kFewInShaft)
      std::erase_if(ids_, [&](PatchId id) { return !shaft.may_meet(scene.patch(id).outline, epsilon_); });
    if (ids_.empty()) return Between::nothing;
    const bool blocked = std::ranges::any_of(
        ids_, [&](PatchId id) { return shaft.blocks(scene.patch(id).outline, epsilon_); });
    return blocked ? Between::blocked : Between::something;
  }

  void accept(NodeId p, NodeId q, const FacePair& pair, bool free) {
    const FlatShape &of_p = tree_[p].shape, &of_q = tree_[q].shape;
    const double weight = oracle_.weight(p, q), least = std::min(of_p.area, of_q.area);
    const double allowed = std::min(kFormFactorShare / weight, kWorstFormFactor * least);
    Link link{p, q, 0, 0, packed(pair.p.slope), packed(pair.q.slope), !free};
    double G_error = moments_error(of_p, of_q) * least, G = 0;
    const bool near = pair.crossing || G_error > allowed;
    SampledPolygon P, Q;
    if (near || !free) {
      P = polygon_of(tree_, p, of_q, epsilon_);
      Q = polygon_of(tree_, q, of_p, epsilon_);
      if (P.corners.empty() || Q.corners.empty()) return;
    }
    if (near) {
      ++result_.counts.contours;
      const Exchange exchange = free_exchange(P, Q, allowed);
      G = exchange.G;
      // As exactly as it can be integrated is good enough for every goal.
      G_error = exchange.error <= allowed ? exchange.error : 0;
    } else {
      G = of_p.area * pair_form_factor(PairRule::moments, of_p, of_q);
    }
    if (!free) {
      const VisibleFraction seen = visible_fraction(refiner_.ray_scene_, P, Q, std::uint64_t{p} << 32 | q,
                                                    {G * weight, kRayShare, kUnanimousShare});
      result_.counts.rays += seen.rays + seen.pilots;
      const double rays(seen.rays);
      if (seen.rays < kMaxPairRays)
        G_error = std::max(
            G_error, G * (seen.agree ? 0.5 * kRayShare / kUnanimousShare / rays : error_at_an_edge(rays)));
      G *= seen.value;
      if (seen.value > 0) {
        link.over_p = packed(seen_slope(tree_, p, seen.at_P));
        link.over_q = packed(seen_slope(tree_, q, seen.at_Q));
      }
    }
    link.G = static_cast<float>(G);
    link.G_error = static_cast<float>(G_error);
    if (G > 0 || !free) result_.links.push_back(link);
  }

  const Refiner& refiner_;
  const NodeTree& tree_;
  LinkOracle oracle_;
  bool settle_;
  std::size_t visits_;  // that are left
  RefinedPairs& result_;
  double epsilon_;
  std::vector<PatchId> ids_;
};

Refiner::Refiner(const RayScene& ray_scene, const NodeTree& tree)
    : ray_scene_(ray_scene),
      tree_(tree),
      patch_tree_(tree.scene()),
      occluders_(make_occluders(tree.scene())) {
  for (std::size_t id = tree.clusters(); id < tree.size(); ++id)
    if (const Node& node = tree[static_cast<NodeId>(id)]; node.is_leaf()) area_ += node.shape.area;
}

void Refiner::refine(const NodePair& pair, std::span<const NodeLight> light, const RefinementGoal& goal,
                     RefinedPairs& result) const {
  refine({pair}, light, goal, std::numeric_limits<std::size_t>::max(), result);
}

void Refiner::refine(const PendingPair& pair, std::span<const NodeLight> light, const RefinementGoal& goal,
                     std::size_t visits, RefinedPairs& result) const {
  Descent(*this, light, goal, visits, result).visit(pair.nodes.p, pair.nodes.q, pair.free);
}

LinkOracle Refiner::oracle(std::span<const NodeLight> light, const RefinementGoal& goal) const {
  return {tree_, light, goal, area_, epsilon()};
}

double Refiner::epsilon() const { return static_cast<double>(ray_scene_.surface_epsilon()); }

}  // namespace fluxel
