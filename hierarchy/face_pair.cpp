#include "hierarchy/face_pair.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <utility>

#include "core/sampling.hpp"
#include "formfactor/view_factor.hpp"
#include "hierarchy/seen_slope.hpp"

namespace fluxel {

namespace {

/// The light has to change so much more along an edge before it is halved though it is the shorter one.
constexpr double kClearly = 2;

struct Heights {
  double low = std::numeric_limits<double>::infinity(), high = -low;
};

/// Of the corners of an outline above the plane of a shape.
Heights heights_above(const FlatShape& shape, const Outline<glm::dvec3>& outline) {
  Heights heights;
  for (std::uint32_t c = 0; c < outline.corners; ++c) {
    const double height = glm::dot(shape.normal, outline.corner[c] - shape.centroid);
    heights.low = std::min(heights.low, height);
    heights.high = std::max(heights.high, height);
  }
  return heights;
}

/// The other face of a pair, as a face p sees it.
struct OtherFace {
  glm::dvec3 normal;  ///< n_q
  glm::dvec3 d;       ///< from the centroid of p to its own [m]
  double height;      ///< height_q, of the centroid of p over its plane [m]
  double r2;          ///< squared distance [m2]
};

/// Triangles are halved so that they stay compact, parallelograms along the edge over which `change` says
/// that the light changes more.
template <class Change>
std::uint32_t edge_to_halve(const NodeTree& tree, NodeId id, const Change& change) {
  const Outline<glm::dvec3>& outline = tree.outline(id);
  const std::uint32_t longest = tree.longest_edge(id);
  if (outline.corners == 3) return longest;
  const double along_longest = change(outline.corner[longest + 1] - outline.corner[longest]);
  const double along_other = change(outline.corner[2 - longest] - outline.corner[1 - longest]);
  return along_other > kClearly * along_longest ? 1 - longest : longest;
}

/// Of the kernel K = height_p height_q / r^4 over the points of p: its gradient over K is
/// n_q / height_q + 4 d / r^2 in the plane of p. `G` is what both exchange, at most `most`.
FacePair::Over estimate_over(const NodeTree& tree, NodeId p, const OtherFace& q, double G, double most) {
  const glm::dvec3 gradient = q.normal / q.height + 4.0 / q.r2 * q.d;
  const glm::dvec2 slope = tree[p].extent * tree.along_axes(p, gradient);
  const double deviation = std::sqrt(glm::dot(slope, tree.covariance(p) * slope));
  const double of_distance = std::sqrt(0.5 * tree[p].shape.moments.trace() / q.r2);
  constexpr double kCurvature = 3;
  const double residual = of_distance * (kCurvature * deviation + 4 * of_distance);
  return {slope, std::min(most, G * std::hypot(deviation, residual)), std::min(most, G * residual),
          edge_to_halve(tree, p, [&](const glm::dvec3& edge) { return std::abs(glm::dot(gradient, edge)); })};
}

/// From far away faces look flat and small; nearer ones are looked at from places of each.
constexpr double kFarSquares = 5;

/// Of a face that is near: what places all over p, each for as much of its area, exchange with q.
FacePair::Over sample_over(const NodeTree& tree, NodeId p, NodeId q, double epsilon, double& G) {
  constexpr std::size_t kAcross = 4, kPlaces = kAcross * kAcross;
  const FlatShape &of_p = tree[p].shape, &of_q = tree[q].shape;
  const Outline<glm::dvec3> outline = tree.outline(q);
  const PolygonView there = corners(outline);
  std::array<glm::dvec2, kPlaces> place;
  std::array<double, kPlaces> F;
  double mean = 0;
  glm::dvec3 at(0);
  for (std::size_t k = 0; k < kPlaces; ++k) {
    const std::size_t column = k % kAcross, row = k / kAcross;
    const double u = (static_cast<double>(column) + 0.5) / kAcross,
                 v = (static_cast<double>(row) + 0.5) / kAcross;
    const glm::dvec3 point = surface_point(tree.outline(p), u, v);
    const bool faces = glm::dot(of_q.normal, point - of_q.centroid) > epsilon;
    F[k] = faces ? point_to_polygon(point, of_p.normal, there) : 0;
    place[k] = tree.place(p, point);
    mean += F[k] / kPlaces;
    at += F[k] / kPlaces * point;
  }
  G = of_p.area * mean;
  FacePair::Over over;
  over.edge = tree.longest_edge(p);
  if (!(mean > 0)) return over;
  over.slope = seen_slope(tree, p, at / mean);
  double squares = 0, left = 0;
  for (std::size_t k = 0; k < kPlaces; ++k) {
    const double change = F[k] - mean, bend = change - mean * glm::dot(over.slope, place[k]);
    squares += change * change / kPlaces;
    left += bend * bend / kPlaces;
  }
  // Of the edges, which places are numbered along, the one over which the mean across the other varies more.
  std::array<std::array<double, kAcross>, 2> sums{};
  for (std::size_t k = 0; k < kPlaces; ++k) {
    sums[0][k % kAcross] += F[k];
    sums[1][k / kAcross] += F[k];
  }
  const auto variation = [&](std::size_t direction) {
    double sum = 0;
    for (const double one : sums[direction]) sum += (one / kAcross - mean) * (one / kAcross - mean);
    return std::sqrt(sum);
  };
  const glm::dvec3 first = tree.outline(p).corner[1] - tree.outline(p).corner[0];
  over.edge = edge_to_halve(tree, p, [&](const glm::dvec3& edge) {
    return variation(std::abs(glm::dot(glm::normalize(first), glm::normalize(edge))) > 1 - 1e-9 ? 0 : 1);
  });
  over.deviation = of_p.area * std::sqrt(squares);
  over.residual = of_p.area * std::sqrt(left);
  return over;
}

bool cone_turns_away(const NodeTree& tree, NodeId cluster, NodeId other) {
  const Node &a = tree[cluster], &b = tree[other];
  const glm::dvec3 d = b.shape.centroid - a.shape.centroid;
  const double r = glm::length(d), reach = a.radius + b.radius;
  if (r <= reach) return false;
  const Cone& cone = tree.cone(cluster);
  const double between = std::acos(std::clamp(glm::dot(cone.axis, d) / r, -1.0, 1.0));
  return between > cone.half_angle + std::numbers::pi / 2 + std::asin(reach / r);
}

/// The area that a node shows towards a direction, at most about. What a cluster's faces show less what they
/// hide is their area times the mean normal's part along the direction, and both together are no more than
/// their area.
double projected_area(const NodeTree& tree, NodeId id, const glm::dvec3& d, double r, double reach) {
  const Node& node = tree[id];
  const double along = std::clamp((glm::dot(node.shape.normal, d) + reach) / r, -1.0, 1.0);
  return (tree.is_cluster(id) ? 0.5 * (1 + along) : std::max(0.0, along)) * node.shape.area;
}

bool turns_away(const NodeTree& tree, NodeId id, NodeId other, double epsilon) {
  if (tree.is_cluster(id)) return cone_turns_away(tree, id, other);
  const FlatShape& shape = tree[id].shape;
  return glm::dot(shape.normal, tree[other].shape.centroid - shape.centroid) + tree[other].radius <= epsilon;
}

}  // namespace

FacePair estimate_face_pair(const NodeTree& tree, NodeId p, NodeId q, double epsilon) {
  const FlatShape &of_p = tree[p].shape, &of_q = tree[q].shape;
  const Heights above_p = heights_above(of_p, tree.outline(q)),
                above_q = heights_above(of_q, tree.outline(p));
  FacePair pair;
  pair.facing = above_p.high > epsilon && above_q.high > epsilon;
  if (!pair.facing) return pair;
  pair.crossing = above_p.low < -epsilon || above_q.low < -epsilon;
  const double most = std::min(of_p.area, of_q.area);
  const glm::dvec3 d = of_q.centroid - of_p.centroid;
  const double r2 = glm::dot(d, d);
  const double height_p = glm::dot(of_p.normal, d), height_q = -glm::dot(of_q.normal, d);
  if (above_p.low < 0 || above_q.low < 0 ||
      r2 < kFarSquares * (of_p.moments.trace() + of_q.moments.trace())) {
    double G_p = 0, G_q = 0;
    pair.p = sample_over(tree, p, q, epsilon, G_p);
    pair.q = sample_over(tree, q, p, epsilon, G_q);
    // The places of the smaller face see more alike.
    const double G = of_p.area == of_q.area ? 0.5 * (G_p + G_q) : of_p.area < of_q.area ? G_p : G_q;
    pair.G = std::min(most, G);
    // Where one of them has told less than there is, its places have missed a small part that has the rest.
    for (const auto& [over, own] : {std::pair(&pair.p, G_p), std::pair(&pair.q, G_q)}) {
      const double missed = std::min(most, std::abs(G - own));
      over->deviation = std::max(over->deviation, missed);
      over->residual = std::max(over->residual, missed);
    }
    return pair;
  }
  pair.G = std::min(most, of_p.area * of_q.area * height_p * height_q / (std::numbers::pi * r2 * r2));
  pair.p = estimate_over(tree, p, {of_q.normal, d, height_q, r2}, pair.G, most);
  pair.q = estimate_over(tree, q, {of_p.normal, -d, height_p, r2}, pair.G, most);
  for (const auto& [id, over] : {std::pair(p, &pair.p), std::pair(q, &pair.q)}) {
    const double too_steep = steepness(tree, id, over->slope);
    if (too_steep <= 1) continue;
    over->slope /= too_steep;
    over->residual = std::min(most, over->residual + (1 - 1 / too_steep) * over->deviation);
  }
  return pair;
}

double largest_exchange(const NodeTree& tree, NodeId p, NodeId q) {
  const glm::dvec3 d = tree[q].shape.centroid - tree[p].shape.centroid;
  const double r = glm::length(d), reach_p = tree[p].radius, reach_q = tree[q].radius;
  if (r <= reach_p + reach_q) return std::min(tree[p].shape.area, tree[q].shape.area);
  const double projected = projected_area(tree, p, d, r, reach_q) * projected_area(tree, q, -d, r, reach_p);
  return std::min({tree[p].shape.area, tree[q].shape.area, projected / (std::numbers::pi * r * r)});
}

bool may_face(const NodeTree& tree, NodeId p, NodeId q, double epsilon) {
  return !turns_away(tree, p, q, epsilon) && !turns_away(tree, q, p, epsilon);
}

}  // namespace fluxel
