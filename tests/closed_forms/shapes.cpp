#include "tests/closed_forms/shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace fluxel::closed_forms {

namespace {
using std::numbers::pi;
}

Polygon reversed(Polygon polygon) {
  std::ranges::reverse(polygon);
  return polygon;
}

std::vector<Polygon> reversed(std::vector<Polygon> polygons) {
  for (Polygon& polygon : polygons) std::ranges::reverse(polygon);
  return polygons;
}

Polygon horizontal(const Rectangle& r, double z) {
  return {{r.u_low, r.v_low, z}, {r.u_high, r.v_low, z}, {r.u_high, r.v_high, z}, {r.u_low, r.v_high, z}};
}

Polygon facing_x(const Rectangle& r, double x) {
  return {{x, r.v_low, r.u_low}, {x, r.v_high, r.u_low}, {x, r.v_high, r.u_high}, {x, r.v_low, r.u_high}};
}

std::pair<Polygon, Polygon> hinged_squares(double angle) {
  const double x = std::cos(angle), z = std::sin(angle);
  return {horizontal({0, 1, 0, 1}, 0), {{0, 0, 0}, {0, 1, 0}, {x, 1, z}, {x, 0, z}}};
}

std::vector<Polygon> box(const glm::dvec3& low, const glm::dvec3& high) {
  const auto at = [&](int x, int y, int z) {
    return glm::dvec3{x != 0 ? high.x : low.x, y != 0 ? high.y : low.y, z != 0 ? high.z : low.z};
  };
  return {{at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0)},
          {at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)},
          {at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)},
          {at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0)},
          {at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0)},
          {at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1)}};
}

std::vector<Polygon> cube(const glm::dvec3& centre, double side) {
  return box(centre - side / 2, centre + side / 2);
}

Polygon regular_polygon(int corners, double circumradius, double z) {
  Polygon polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * pi * i / corners;
    polygon.emplace_back(circumradius * std::cos(angle), circumradius * std::sin(angle), z);
  }
  return polygon;
}

Polygon disc(int corners, double radius, double z) {
  const double angle = 2 * pi / corners;
  return regular_polygon(corners, radius * std::sqrt(angle / std::sin(angle)), z);
}

std::vector<Polygon> geodesic_sphere(int frequency, const glm::dvec3& centre, double radius) {
  constexpr double kGolden = std::numbers::phi;
  const std::array<glm::dvec3, 12> corner{{{-1, kGolden, 0},
                                           {1, kGolden, 0},
                                           {-1, -kGolden, 0},
                                           {1, -kGolden, 0},
                                           {0, -1, kGolden},
                                           {0, 1, kGolden},
                                           {0, -1, -kGolden},
                                           {0, 1, -kGolden},
                                           {kGolden, 0, -1},
                                           {kGolden, 0, 1},
                                           {-kGolden, 0, -1},
                                           {-kGolden, 0, 1}}};
  constexpr std::array<std::array<std::size_t, 3>, 20> kFaces{
      {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
       {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
       {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};

  std::vector<Polygon> sphere;
  for (const auto& face : kFaces) {
    const glm::dvec3 a = corner[face[0]], b = corner[face[1]], c = corner[face[2]];
    const auto at = [&](int i, int j) {
      return glm::normalize(double(frequency - i - j) * a + double(i) * b + double(j) * c);
    };
    for (int i = 0; i < frequency; ++i) {
      for (int j = 0; i + j < frequency; ++j) {
        sphere.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
        if (i + j + 1 < frequency) sphere.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
  }
  const double scale = radius * std::sqrt(4 * pi / area(sphere));
  for (Polygon& triangle : sphere) {
    for (glm::dvec3& point : triangle) point = centre + scale * point;
  }
  return sphere;
}

}  // namespace fluxel::closed_forms
