#include "scene/polygon.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

namespace fluxel {
namespace {

glm::dvec3 triangle_area_vector(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  return 0.5 * glm::cross(b - a, c - a);
}

/// True where one of `a`'s edges has all of `b` outside, or inside by no more than `tolerance`.
bool separated_by_edge(PolygonView a, PolygonView b, const glm::dvec3& normal_a, double tolerance) {
  for (std::size_t edge = 0; edge < a.size(); ++edge) {
    const Plane plane = edge_plane(a, edge, normal_a);
    if (std::all_of(b.begin(), b.end(), [&](const auto& x) { return plane.distance(x) <= tolerance; })) {
      return true;
    }
  }
  return false;
}

/// Height over longest edge: 0 for a needle, 0.866 for an equilateral triangle.
double shape(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const double longest = std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)});
  return longest > 0 ? 2 * glm::length(triangle_area_vector(a, b, c)) / longest : 0;
}

/// The best triangulation of each chain of corners first..last, closed by its diagonal.
struct ConvexTriangulation {
  explicit ConvexTriangulation(PolygonView polygon) : corner(polygon), apex(polygon.size() * polygon.size()) {
    const std::size_t n = corner.size();
    std::vector<double> worst(n * n, std::numeric_limits<double>::infinity());
    for (std::size_t length = 2; length < n; ++length) {
      for (std::size_t first = 0; first + length < n; ++first) {
        const std::size_t last = first + length;
        double best = -1;
        for (std::size_t middle = first + 1; middle < last; ++middle) {
          const double candidate = std::min({shape(corner[first], corner[middle], corner[last]),
                                             worst[first * n + middle], worst[middle * n + last]});
          if (candidate > best) {
            best = candidate;
            apex[first * n + last] = middle;
          }
        }
        worst[first * n + last] = best;
      }
    }
  }

  void emit(std::size_t first, std::size_t last, std::vector<Outline<glm::dvec3>>& out) const {
    if (last - first < 2) return;
    const std::size_t middle = apex[first * corner.size() + last];
    out.push_back({{corner[first], corner[middle], corner[last]}, 3});
    emit(first, middle, out);
    emit(middle, last, out);
  }

  PolygonView corner;
  std::vector<std::size_t> apex;
};

}  // namespace

double Plane::distance(const glm::dvec3& x) const { return glm::dot(normal, x - point); }

glm::dvec3 area_vector(PolygonView polygon) {
  glm::dvec3 sum{0};
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    sum += triangle_area_vector(polygon[0], polygon[i - 1], polygon[i]);
  }
  return sum;
}

double area(PolygonView polygon) { return glm::length(area_vector(polygon)); }

glm::dvec3 centroid(PolygonView polygon) {
  double total = 0;
  glm::dvec3 sum{0};
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const double part = glm::length(triangle_area_vector(polygon[0], polygon[i - 1], polygon[i]));
    sum += part / 3 * ((polygon[i - 1] - polygon[0]) + (polygon[i] - polygon[0]));
    total += part;
  }
  return total > 0 ? polygon[0] + sum / total : polygon[0];
}

Plane edge_plane(PolygonView polygon, std::size_t edge, const glm::dvec3& normal) {
  const glm::dvec3& from = polygon[edge];
  const glm::dvec3 inward = glm::cross(normal, polygon[(edge + 1) % polygon.size()] - from);
  const double length = glm::length(inward);
  return {from, length > 0 ? inward / length : glm::dvec3{0}};
}

double squared_distance(const glm::dvec3& point, PolygonView polygon, const glm::dvec3& normal) {
  double of_edges = std::numeric_limits<double>::infinity();
  bool above = true;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const glm::dvec3 edge = polygon[(k + 1) % polygon.size()] - polygon[k], d = point - polygon[k];
    above = above && glm::dot(glm::cross(normal, edge), d) >= 0;
    const double length2 = glm::dot(edge, edge);
    const double along = length2 > 0 ? std::clamp(glm::dot(d, edge) / length2, 0.0, 1.0) : 0;
    const glm::dvec3 off = d - along * edge;
    of_edges = std::min(of_edges, glm::dot(off, off));
  }
  const double height = glm::dot(normal, point - polygon[0]);
  return above ? height * height : of_edges;
}

double width(PolygonView polygon, const glm::dvec3& normal) {
  double least = polygon.size() < 3 ? 0 : std::numeric_limits<double>::infinity();
  for (std::size_t edge = 0; edge < polygon.size(); ++edge) {
    const Plane plane = edge_plane(polygon, edge, normal);
    double most = 0;
    for (const glm::dvec3& x : polygon) most = std::max(most, plane.distance(x));
    if (plane.normal != glm::dvec3{0}) least = std::min(least, most);
  }
  return least;
}

bool share_area(PolygonView a, PolygonView b, const glm::dvec3& normal_a, const glm::dvec3& normal_b,
                double tolerance) {
  if (separated_by_edge(a, b, normal_a, tolerance) || separated_by_edge(b, a, normal_b, tolerance)) {
    return false;
  }
  Polygon common(a.begin(), a.end());
  for (std::size_t edge = 0; edge < b.size() && !common.empty(); ++edge) {
    common = split(common, edge_plane(b, edge, normal_b), tolerance).front;
  }
  return width(common, normal_a) > tolerance;
}

std::optional<Segment> clip(const Segment& segment, PolygonView polygon, const glm::dvec3& normal,
                            double inset) {
  double begin = 0, end = 1;
  for (std::size_t edge = 0; edge < polygon.size(); ++edge) {
    const Plane plane = edge_plane(polygon, edge, normal);
    if (plane.normal == glm::dvec3{0}) continue;
    const double at_begin = plane.distance(segment.from) - inset;
    const double at_end = plane.distance(segment.to) - inset;
    if (at_begin <= 0 && at_end <= 0) return std::nullopt;
    if (at_begin < 0) begin = std::max(begin, at_begin / (at_begin - at_end));
    if (at_end < 0) end = std::min(end, at_begin / (at_begin - at_end));
    if (begin >= end) return std::nullopt;
  }
  const glm::dvec3 along = segment.to - segment.from;
  return Segment{begin > 0 ? segment.from + begin * along : segment.from,
                 end < 1 ? segment.from + end * along : segment.to};
}

Halves split(const Polygon& polygon, const Plane& plane, double tolerance) {
  const std::size_t n = polygon.size();
  if (n < 3) return {};
  std::vector<double> distance(n);
  for (std::size_t i = 0; i < n; ++i) distance[i] = plane.distance(polygon[i]);
  const auto [least, most] = std::minmax_element(distance.begin(), distance.end());
  if (*most <= tolerance) return {{}, polygon};
  if (*least >= -tolerance) return {polygon, {}};

  // Around a convex polygon stand: corners in front, corners on the plane, corners behind, corners on it.
  std::size_t start = 0;
  while (distance[start] <= tolerance || distance[(start + n - 1) % n] > tolerance) ++start;
  Polygon corner(n);
  for (std::size_t i = 0; i < n; ++i) corner[i] = polygon[(start + i) % n];
  std::rotate(distance.begin(), distance.begin() + static_cast<std::ptrdiff_t>(start), distance.end());
  const auto run_end = [&](std::size_t i, auto belongs) {
    while (i < n && belongs(distance[i])) ++i;
    return i;
  };
  const std::size_t on = run_end(0, [&](double d) { return d > tolerance; });
  const std::size_t behind = run_end(on, [&](double d) { return d >= -tolerance; });
  const std::size_t on_again = run_end(behind, [&](double d) { return d < -tolerance; });

  Halves halves;
  const auto append = [&](Polygon& half, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) half.push_back(corner[i]);
  };
  // Of several corners on the plane the nearest ends the cut: only one may, or the halves would overlap.
  const auto cross = [&](std::size_t first, std::size_t last, Polygon& before, Polygon& after) {
    if (first == last) {
      const std::size_t from = first - 1, to = first % n;
      const double t = distance[from] / (distance[from] - distance[to]);
      const glm::dvec3 crossing = corner[from] + t * (corner[to] - corner[from]);
      before.push_back(crossing);
      after.push_back(crossing);
    } else {
      std::size_t nearest = first;
      for (std::size_t i = first; i < last; ++i) {
        if (std::abs(distance[i]) < std::abs(distance[nearest])) nearest = i;
      }
      append(before, first, nearest + 1);
      append(after, nearest, last);
    }
  };
  append(halves.front, 0, on);
  cross(on, behind, halves.front, halves.back);
  append(halves.back, behind, on_again);
  cross(on_again, n, halves.back, halves.front);
  return halves;
}

std::vector<Polygon> difference(const Polygon& polygon, PolygonView cutter, const glm::dvec3& cutter_normal,
                                double tolerance, double& covered) {
  const glm::dvec3 normal = glm::normalize(area_vector(polygon));
  if (!share_area(polygon, cutter, normal, cutter_normal, tolerance)) return {polygon};
  std::vector<Polygon> remaining;
  Polygon inside = polygon;
  for (std::size_t edge = 0; edge < cutter.size(); ++edge) {
    Halves halves = split(inside, edge_plane(cutter, edge, cutter_normal), tolerance);
    if (halves.front.empty()) return {polygon};
    if (!halves.back.empty()) remaining.push_back(std::move(halves.back));
    inside = std::move(halves.front);
  }
  covered += area(inside);
  return remaining;
}

std::vector<Outline<glm::dvec3>> to_outlines(const Polygon& polygon, double rounding) {
  const std::size_t n = polygon.size();
  if (n < 3) return {};
  if (n == 3) return {{{polygon[0], polygon[1], polygon[2]}, 3}};
  if (n == 4 && glm::length((polygon[0] - polygon[1]) + (polygon[2] - polygon[3])) <= rounding) {
    return {{{polygon[0], polygon[1], polygon[2], polygon[3]}, 4}};
  }
  std::vector<Outline<glm::dvec3>> out;
  ConvexTriangulation(polygon).emit(0, n - 1, out);
  return out;
}

}  // namespace fluxel
