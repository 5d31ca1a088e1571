#include "hierarchy/face_pair.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

namespace fluxel {

namespace {

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
  double r2;          ///< squared distance, bounded from below [m2]
};

/// Of the kernel K = height_p height_q / r^4 over the points of p: its gradient over K is
/// n_q / height_q + 4 d / r^2 in the plane of p. `G` is what both exchange, at most `most`.
FacePair::Over estimate_over(const NodeTree& tree, NodeId p, const OtherFace& q, double G, double most) {
  const FlatShape& shape = tree[p].shape;
  const PlaneAxes axes = tree.axes(p);
  const glm::dvec3 gradient = q.normal / q.height + 4.0 / std::max(glm::dot(q.d, q.d), 0.1 * q.r2) * q.d;
  const glm::dvec2 in_plane(glm::dot(gradient, axes.u), glm::dot(gradient, axes.v));
  const double of_points = std::sqrt(0.5 * shape.moments.trace());  // of points along an axis [m]
  const double deviation = of_points * glm::length(in_plane), of_distance = of_points / std::sqrt(q.r2);
  constexpr double kCurvature = 3;
  const double residual = of_distance * (kCurvature * deviation + 4 * of_distance);
  return {tree[p].radius * in_plane, std::min(most, G * std::hypot(deviation, residual)),
          std::min(most, G * residual)};
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

/// The area that a node shows towards a direction, at most about: of a closed body it is a quarter of all its
/// area.
double projected_area(const NodeTree& tree, NodeId id, const glm::dvec3& d, double r, double reach) {
  const Node& node = tree[id];
  if (tree.is_cluster(id))
    return (tree.cone(id).half_angle > std::numbers::pi / 3 ? 0.5 : 1.0) * node.shape.area;
  return std::clamp((glm::dot(node.shape.normal, d) + reach) / r, 0.0, 1.0) * node.shape.area;
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
  // Where the centroids do not face each other the parts that do are at about a quarter of their height.
  constexpr double kMinHeight = 0.25;
  const glm::dvec3 d = of_q.centroid - of_p.centroid;
  const double r2 = std::max(glm::dot(d, d), kNearestSquares * (of_p.moments.trace() + of_q.moments.trace()));
  const double height_p = std::max(glm::dot(of_p.normal, d), kMinHeight * above_p.high);
  const double height_q = std::max(-glm::dot(of_q.normal, d), kMinHeight * above_q.high);
  const double most = std::min(of_p.area, of_q.area);
  pair.G = std::min(most, of_p.area * of_q.area * height_p * height_q / (std::numbers::pi * r2 * r2));
  pair.p = estimate_over(tree, p, {of_q.normal, d, height_q, r2}, pair.G, most);
  pair.q = estimate_over(tree, q, {of_p.normal, -d, height_p, r2}, pair.G, most);
  const double slopes = glm::length(pair.p.slope) + glm::length(pair.q.slope);
  if (slopes > 1) {
    for (FacePair::Over* over : {&pair.p, &pair.q}) {
      over->slope /= slopes;
      over->residual = std::min(most, over->residual + (1 - 1 / slopes) * over->deviation);
    }
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
