#include "formfactor/view_factor.hpp"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

namespace fluxel {

namespace {

/// A side of a polygon as the line integrals need it.
struct Edge {
  glm::dvec3 from, direction;  // unit
  double length;
};

using Edges = boost::container::small_vector<Edge, 8>;

Edges edges_of(PolygonView polygon) {
  Edges edges;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const glm::dvec3 along = polygon[(k + 1) % polygon.size()] - polygon[k];
    const double length = glm::length(along);
    if (length > 0) edges.push_back({polygon[k], along / length, length});
  }
  return edges;
}

/// The integral of ln |x - y| over y on an edge. With t along the edge from the foot of x and q the distance
/// from its line, the antiderivative of ln sqrt(t^2 + q^2) is t/2 ln(t^2 + q^2) - t + q atan(t/q).
double log_distance_along(const Edge& edge, const glm::dvec3& x) {
  const glm::dvec3 from_start = x - edge.from;
  const double foot = glm::dot(from_start, edge.direction);
  const double q = glm::length(from_start - foot * edge.direction);
  const double t0 = -foot, t1 = edge.length - foot;
  const auto antiderivative = [q](double t) {
    const double square = t * t + q * q;
    return square > 0 ? 0.5 * t * std::log(square) - t : 0.0;
  };
  // One arc tangent of the difference instead of two: the angle under which x sees the edge.
  const double angle = q > 0 ? std::atan2(q * edge.length, q * q + t0 * t1) : 0.0;
  return antiderivative(t1) - antiderivative(t0) + q * angle;
}

/// The integral of cosine times ln |x - y| over y on all edges, the cosines being those with `direction`.
double log_distance_to_contour(const Edges& inner, const glm::dvec3& direction, const glm::dvec3& x) {
  double sum = 0;
  for (const Edge& edge : inner) {
    const double cosine = glm::dot(direction, edge.direction);
    if (cosine != 0) sum += cosine * log_distance_along(edge, x);
  }
  return sum;
}

/// Gauss-Legendre over [from, to] of an edge; graded at both ends by s -> 3 s^2 - 2 s^3, which turns the x ln
/// x of a shared or near corner into something smooth enough.
template <unsigned points>
double integrate_stretch(const Edge& outer, const Edges& inner, double from, double to, bool graded) {
  const auto integrand = [&](double s) {
    const double place = graded ? s * s * (3 - 2 * s) : s;
    const double density = graded ? 6 * s * (1 - s) : 1.0;
    const glm::dvec3 x = outer.from + (from + place * (to - from)) * outer.direction;
    return density * log_distance_to_contour(inner, outer.direction, x);
  };
  return (to - from) * boost::math::quadrature::gauss<double, points>::integrate(integrand, 0.0, 1.0);
}

/// Where the rule on an outer edge is broken.
struct Stops {
  boost::container::small_vector<double, 16> at;
  bool graded = false;

  /// Where it passes other edges between the ends of both, no further away than `reach`. Parallel edges bend
  /// the integrand at their corners only, perpendicular ones do not count.
  void add_passes(const Edge& outer, const Edges& edges, double reach) {
    for (const Edge& edge : edges) {
      const double cosine = glm::dot(outer.direction, edge.direction), square_sine = 1 - cosine * cosine;
      if (cosine * cosine * square_sine < 1e-9) continue;
      const glm::dvec3 between = edge.from - outer.from;
      const double a = glm::dot(between, outer.direction), b = glm::dot(between, edge.direction);
      const double place = (a - cosine * b) / square_sine, other = (cosine * a - b) / square_sine;
      if (place <= 0 || place >= outer.length || other <= 0 || other >= edge.length) continue;
      if (glm::length(between + other * edge.direction - place * outer.direction) > reach) continue;
      graded = true;
      at.push_back(place);
    }
  }

  /// At the foot of every corner that is no further from the edge than `reach`.
  void add_corners(const Edge& outer, const Edges& edges, double reach) {
    for (const Edge& edge : edges) {
      const double along = glm::dot(edge.from - outer.from, outer.direction);
      const double place = std::clamp(along, 0.0, outer.length);
      if (glm::length(edge.from - outer.from - place * outer.direction) > reach) continue;
      graded = true;
      if (place > 0 && place < outer.length) at.push_back(place);
    }
  }
};

void measure_in(double unit, Edges& edges) {
  for (Edge& edge : edges) {
    edge.from /= unit;
    edge.length /= unit;
  }
}

double longest(const Edges& edges) {
  double length = 0;
  for (const Edge& edge : edges) length = std::max(length, edge.length);
  return length;
}

template <unsigned points>
double contour_integral(PolygonView P, PolygonView Q) {
  Edges outer = edges_of(P), inner = edges_of(Q);
  // The longer edges inside, where the integral is closed.
  if (longest(outer) > longest(inner)) std::swap(outer, inner);
  // Around a contour the logarithm of the unit of length cancels but for its rounding: in a unit, a power of
  // two, near the lengths at hand there is next to none.
  if (outer.empty()) return 0;
  const double unit = std::ldexp(1.0, std::ilogb(longest(inner)));
  measure_in(unit, outer);
  measure_in(unit, inner);
  // The integrand bends sharply only beside the corners of the inner polygon and where edges pass each other,
  // over a length like their distance from the outer edge. The long edges of a sliver nearly cancel: they
  // must be broken at the same places for their errors to cancel too, hence one reach for all edges (that no
  // distance in a regular mesh equals), and stops at the sliver's own corners.
  const double reach = 0.93 * longest(outer), thin = 0.13 * longest(outer);
  double sum = 0;
  for (const Edge& edge : outer) {
    Stops stops;
    stops.at.push_back(0);
    stops.add_corners(edge, inner, reach);
    stops.add_passes(edge, inner, reach);
    const bool graded = stops.graded;
    stops.add_corners(edge, outer, thin);
    stops.at.push_back(edge.length);
    std::sort(stops.at.begin(), stops.at.end());
    for (std::size_t k = 0; k + 1 < stops.at.size(); ++k)
      if (stops.at[k + 1] > stops.at[k])
        sum += integrate_stretch<points>(edge, inner, stops.at[k], stops.at[k + 1], graded);
  }
  return std::max(0.0, unit * unit * sum / (2 * std::numbers::pi));
}

}  // namespace

SmallPolygon clip_to_front(PolygonView polygon, const Plane& plane, double tolerance) {
  const auto height = [&plane, tolerance](const glm::dvec3& corner) {
    const double distance = plane.distance(corner);
    return std::abs(distance) <= tolerance ? 0.0 : distance;
  };
  SmallPolygon front;
  bool area = false;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const glm::dvec3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double height_a = height(a), height_b = height(b);
    if (height_a >= 0) front.push_back(a);
    area = area || height_a > 0;
    if ((height_a < 0 && height_b > 0) || (height_a > 0 && height_b < 0))
      front.push_back(a + height_a / (height_a - height_b) * (b - a));
  }
  if (!area || front.size() < 3) front.clear();
  return front;
}

double point_to_polygon(const glm::dvec3& point, const glm::dvec3& normal, PolygonView polygon) {
  const SmallPolygon above = clip_to_front(polygon, {point, normal});
  double sum = 0;
  for (std::size_t k = 0; k < above.size(); ++k) {
    const glm::dvec3 a = above[k] - point, b = above[(k + 1) % above.size()] - point;
    const glm::dvec3 across = glm::cross(a, b);
    const double sine = glm::length(across);
    if (sine > 0) sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(normal, across) / sine;
  }
  return std::abs(sum) / (2 * std::numbers::pi);
}

double exchange_area_by_contour(PolygonView P, PolygonView Q, ContourPoints points) {
  return points == ContourPoints::coarse
             ? contour_integral<static_cast<unsigned>(ContourPoints::coarse)>(P, Q)
             : contour_integral<static_cast<unsigned>(ContourPoints::fine)>(P, Q);
}

}  // namespace fluxel
