#include "tests/closed_forms/polygons.hpp"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace fluxel::closed_forms {

namespace {

using std::numbers::pi;

/// Halvings of an edge towards a touching one: the rest, 2^-24 of it, holds less than rounding of x ln x.
constexpr int kMaxHalvings = 24;

struct Edge {
  glm::dvec3 start, along;  ///< `along` is a unit vector
  double length;
};

std::vector<Edge> edges_of(const Polygon& polygon) {
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3 way = polygon[(i + 1) % polygon.size()] - polygon[i];
    const double length = glm::length(way);
    if (length > 0) edges.push_back({polygon[i], way / length, length});
  }
  return edges;
}

/// int ln sqrt(t^2 + q^2) dt
double primitive(double t, double q) {
  const double square = t * t + q * q;
  return square == 0 ? 0 : t / 2 * std::log(square) - t + q * std::atan2(t, q);
}

/// int ln r along an edge, seen from a point.
double log_distance(const glm::dvec3& point, const Edge& edge) {
  const glm::dvec3 to_start = edge.start - point;
  const double t = glm::dot(to_start, edge.along), q = glm::length(glm::cross(to_start, edge.along));
  return primitive(t + edge.length, q) - primitive(t, q);
}

double distance_to_ends(const glm::dvec3& point, const Edge& edge) {
  return std::min(glm::distance(point, edge.start),
                  glm::distance(point, edge.start + edge.length * edge.along));
}

double distance_to(const glm::dvec3& point, const Edge& edge) {
  const double t = std::clamp(glm::dot(point - edge.start, edge.along), 0.0, edge.length);
  return glm::distance(point, edge.start + t * edge.along);
}

bool on_one_line(const Edge& a, const Edge& b) {
  const double tiny = 1e-14 * (a.length + b.length + glm::distance(a.start, b.start));
  const glm::dvec3 end = a.start + a.length * a.along;
  return glm::length(glm::cross(a.start - b.start, b.along)) < tiny &&
         glm::length(glm::cross(end - b.start, b.along)) < tiny;
}

/// int int ln r over the piece [low, high] of edge i and all of edge j.
double double_integral(const Edge& i, double low, double high, const Edge& j, bool one_line, int halvings) {
  const glm::dvec3 middle = i.start + (low + high) / 2 * i.along;
  // On j's own line the inner integral is smooth but at j's ends; elsewhere it has a kink on j itself.
  const double distance = one_line ? distance_to_ends(middle, j) : distance_to(middle, j);
  if (distance >= high - low || halvings == kMaxHalvings) {
    const auto inner = [&](double s) { return log_distance(i.start + s * i.along, j); };
    return boost::math::quadrature::gauss<double, 20>::integrate(inner, low, high);
  }
  const double half = (low + high) / 2;
  return double_integral(i, low, half, j, one_line, halvings + 1) +
         double_integral(i, half, high, j, one_line, halvings + 1);
}

}  // namespace

glm::dvec3 vector_area(const Polygon& polygon) {
  glm::dvec3 sum(0);
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    sum += glm::cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  }
  return sum / 2.0;
}

double area(const Polygon& polygon) { return glm::length(vector_area(polygon)); }

double area(std::span<const Polygon> polygons) {
  double sum = 0;
  for (const Polygon& polygon : polygons) sum += area(polygon);
  return sum;
}

Polygon clip(const Polygon& polygon, const glm::dvec3& point, const glm::dvec3& normal) {
  std::vector<double> height;
  double extent = 0;
  for (const glm::dvec3& corner : polygon) {
    height.push_back(glm::dot(corner - point, normal));
    extent = std::max(extent, glm::distance(corner, point));
  }
  // Corners on the plane but for rounding are on it: common edges must stay common.
  for (double& h : height) h = std::abs(h) < 1e-14 * extent ? 0 : h;
  if (std::ranges::none_of(height, [](double h) { return h > 0; })) return {};

  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t next = (i + 1) % polygon.size();
    if (height[i] >= 0) kept.push_back(polygon[i]);
    if (height[i] * height[next] < 0) {
      kept.push_back(polygon[i] + height[i] / (height[i] - height[next]) * (polygon[next] - polygon[i]));
    }
  }
  return kept;
}

double point_to_polygon(const glm::dvec3& point, const glm::dvec3& normal, const Polygon& polygon) {
  const Polygon seen = clip(polygon, point, normal);
  double sum = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const glm::dvec3 a = seen[i] - point, b = seen[(i + 1) % seen.size()] - point, across = glm::cross(a, b);
    const double sine = glm::length(across);
    if (sine > 0) sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(normal, across) / sine;
  }
  return std::abs(sum) / (2 * pi);
}

double exchange_area(const Polygon& polygon_1, const Polygon& polygon_2) {
  const Polygon first = clip(polygon_1, polygon_2[0], glm::normalize(vector_area(polygon_2)));
  const Polygon second = clip(polygon_2, polygon_1[0], glm::normalize(vector_area(polygon_1)));
  const std::vector<Edge> second_edges = edges_of(second);
  double sum = 0;
  for (const Edge& i : edges_of(first)) {
    for (const Edge& j : second_edges) {
      const double cosine = glm::dot(i.along, j.along);
      if (cosine != 0) sum += cosine * double_integral(i, 0, i.length, j, on_one_line(i, j), 0);
    }
  }
  return sum / (2 * pi);
}

double exchange_area(std::span<const Polygon> group_1, std::span<const Polygon> group_2) {
  double sum = 0;
  for (const Polygon& polygon_1 : group_1) {
    for (const Polygon& polygon_2 : group_2) sum += exchange_area(polygon_1, polygon_2);
  }
  return sum;
}

double polygon_to_polygon(const Polygon& sender, const Polygon& receiver) {
  return exchange_area(sender, receiver) / area(sender);
}

}  // namespace fluxel::closed_forms
