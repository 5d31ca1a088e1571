#include "scene/convexity.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <numbers>

#include "scene_by_hand.hpp"

namespace fluxel {
namespace {

using namespace by_hand;

Scene cube(bool outward) {
  Scene scene = empty_scene(Sides::one);
  add_box(scene, "cube", {-1, -1, -1}, {1, 1, 1}, outward);
  scene.extent = 1;
  return scene;
}

/// A sphere of triangles, from `rings` rings of latitude.
Scene sphere(int rings) {
  Scene scene = empty_scene(Sides::one);
  scene.extent = 1;
  const auto point = [&](int i, int j) {
    const double theta = std::numbers::pi * i / rings, phi = std::numbers::pi * j / rings;
    return glm::dvec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
  };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < 2 * rings; ++j) {
      if (i + 1 < rings) add(scene, "sphere", {point(i, j), point(i + 1, j), point(i + 1, j + 1)});
      if (i > 0) add(scene, "sphere", {point(i, j), point(i + 1, j + 1), point(i, j + 1)});
    }
  }
  return scene;
}

TEST(Convexity, OfRoomsAndSpheres) {
  std::mt19937 random(8);
  for (const bool outward : {true, false}) {
    Scene scene = cube(outward);
    rotate(scene, random_rotation(random));
    EXPECT_TRUE(is_convex(scene));
  }
  EXPECT_TRUE(is_convex(sphere(12)));
}

TEST(Convexity, ALampInTheCeilingHangsInNobodysWayAndOneBelowItDoes) {
  Scene scene = cube(false);
  const auto lamp = [](double z) {
    return std::vector<glm::dvec3>{{-0.5, -0.5, z}, {-0.5, 0.5, z}, {0.5, 0.5, z}, {0.5, -0.5, z}};
  };
  add(scene, "lamp", lamp(1), kLight);
  EXPECT_TRUE(is_convex(scene));
  add(scene, "lower lamp", lamp(1 - 1e-3), kLight);
  EXPECT_FALSE(is_convex(scene));
}

TEST(Convexity, NotOfAnLOrWithATable) {
  Scene ell = empty_scene(Sides::one);
  ell.extent = 2;
  // Its walls; the inner corner stands before others.
  const std::vector<glm::dvec2> plan{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const glm::dvec3 a(plan[i], 0), b(plan[(i + 1) % plan.size()], 0), up(0, 0, 1);
    add(ell, "wall", {b, a, a + up, b + up});
  }
  EXPECT_FALSE(is_convex(ell));
  Scene room = cube(false);
  add(room, "table", {{-0.1, -0.1, 0}, {0.1, -0.1, 0}, {0, 0.1, 0}});
  EXPECT_FALSE(is_convex(room));
}

TEST(Convexity, ManyPlanesAreGivenUpSoon) {
  const Scene scene = sphere(100);  // 39,600 patches
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(is_convex(scene));
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), 20);
}

}  // namespace
}  // namespace fluxel
