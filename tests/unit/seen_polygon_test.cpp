#include "formfactor/seen_polygon.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <numbers>

#include "formfactor/even_points.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

struct Flat {
  Polygon corners;
  glm::dvec3 normal{0};
};

/// Of a triangle or parallelogram, and three corners or four of a cut.
Flat random_flat_polygon(std::mt19937& random) {
  const glm::dvec3 corner = test_scenes::uniform_point(random, -1, 1);
  const glm::dvec3 u = test_scenes::uniform_point(random, -1, 1),
                   v = test_scenes::uniform_point(random, -1, 1);
  Polygon corners{corner, corner + u, corner + u + v, corner + v};
  if (random() % 2 == 0) corners.pop_back();
  return {corners, glm::normalize(area_vector(corners))};
}

TEST(SeenPolygon, TheWallsOfACubeAreAllDirections) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add_box(scene, "room", glm::dvec3(-1), glm::dvec3(1), false);
  scene = test_scenes::finished(std::move(scene));
  std::mt19937 random(1);
  for (int repeat = 0; repeat < 100; ++repeat) {
    // Some of the points all but touch a wall.
    glm::dvec3 from = test_scenes::uniform_point(random, -1, 1);
    if (repeat % 2 == 0) from.x = 1 - 1e-7;
    double sum = 0;
    for (const Patch& patch : scene.patches)
      sum += SeenPolygon(from, corners(patch.outline), patch.normal).solid_angle();
    EXPECT_NEAR(sum, 4 * std::numbers::pi, 1e-9);
  }
}

TEST(SeenPolygon, PointsLieInThePolygonAndAddUpToItsFormFactor) {
  std::mt19937 random(2);
  for (int repeat = 0; repeat < 200; ++repeat) {
    const Flat flat = random_flat_polygon(random);
    const glm::dvec3 from = test_scenes::uniform_point(random, -1, 1);
    const double height = std::abs(glm::dot(flat.normal, flat.corners[0] - from));
    if (height < 1e-3 || area(flat.corners) < 0.05) continue;
    const SeenPolygon seen(from, flat.corners, flat.normal);
    const glm::dvec3 normal = test_scenes::random_direction(random);
    SobolPoints places(random());
    constexpr int kPoints = 4096;
    double sum = 0;
    for (int k = 0; k < kPoints; ++k) {
      const auto [u, v, s, t] = places.next();
      const glm::dvec3 x = seen.point(u, v);
      EXPECT_NEAR(glm::dot(flat.normal, x - flat.corners[0]), 0, 1e-9);
      for (std::size_t edge = 0; edge < flat.corners.size(); ++edge)
        EXPECT_GT(edge_plane(flat.corners, edge, flat.normal).distance(x), -1e-6);
      sum += std::max(0.0, glm::dot(normal, glm::normalize(x - from)));
    }
    EXPECT_NEAR(seen.solid_angle() * sum / kPoints / std::numbers::pi,
                point_to_polygon(from, normal, flat.corners), 1e-3);
  }
}

TEST(SeenPolygon, EveryPartGetsItsShareOfTheDirections) {
  std::mt19937 random(3);
  for (int repeat = 0; repeat < 100; ++repeat) {
    const Flat flat = random_flat_polygon(random);
    // Often so near that most of the directions end on a small part.
    const glm::dvec3 inside = centroid(flat.corners), across = flat.corners[0] - inside;
    const glm::dvec3 from = inside + (repeat % 4 == 0 ? 1.0 : 1e-4) * glm::length(across) * flat.normal;
    const Plane plane{inside + 0.1 * across, glm::normalize(across)};
    const Halves halves = split(flat.corners, plane, 1e-9);
    const SeenPolygon seen(from, flat.corners, flat.normal);
    const double share = SeenPolygon(from, halves.front, flat.normal).solid_angle() / seen.solid_angle();
    SobolPoints places(random());
    constexpr int kPoints = 4096;
    int in_front = 0;
    for (int k = 0; k < kPoints; ++k) {
      const auto [u, v, s, t] = places.next();
      in_front += plane.distance(seen.point(u, v)) > 0 ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(in_front) / kPoints, share, 0.01);
  }
}

// Of elements that touch, a point of one may be a corner of the other.
TEST(SeenPolygon, ACornerWhereThePointLies) {
  const std::vector<glm::dvec3> triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const SeenPolygon seen(triangle[0], triangle, {0, 0, 1});
  for (const double u : {0.1, 0.5, 0.9}) {
    const glm::dvec3 point = seen.point(u, 1 - u);
    EXPECT_TRUE(std::isfinite(point.x + point.y + point.z));
  }
}

}  // namespace
}  // namespace fluxel
