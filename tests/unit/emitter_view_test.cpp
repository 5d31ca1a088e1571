#include "hierarchy/emitter_view.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>

#include "formfactor/even_points.hpp"
#include "formfactor/view_factor.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

Scene shining_plates(int count) {
  Scene scene = test_scenes::random_plates(count, 0.2, Sides::two, 7);
  for (std::size_t k = 0; k < scene.patches.size(); k += 3) scene.patches[k].material = by_hand::kLight;
  return scene;
}

TEST(EmitterView, TellsTheChanceOfWhatItDraws) {
  for (const int count : {1, 4, 60, 400}) {
    const Scene scene = shining_plates(count);
    const NodeTree tree(scene);
    const RayScene ray_scene(scene, 1);
    const EmitterDraw emitters(tree, ray_scene);
    std::mt19937 random(3);
    for (const glm::dvec3 from : {glm::dvec3(0), glm::dvec3(1, 0.5, -2), glm::dvec3(30, 0, 0)}) {
      const ReceivingPoint at{from, test_scenes::random_direction(random),
                              emitters.region_of(static_cast<NodeId>(tree.clusters()))};
      const EmitterView view(emitters, at);
      if (view.empty()) continue;
      constexpr int kDraws = 20000;
      std::map<NodeId, int> drawn;
      std::map<NodeId, double> share;  // the mean over its own draws of 1 over the density times the area
      for (int k = 0; k < kDraws; ++k) {
        const DrawnEmitter one =
            view.draw(test_scenes::uniform(random, 0, 1), test_scenes::uniform(random, 0, 1),
                      test_scenes::uniform(random, 0, 1));
        ASSERT_TRUE(emitters.emits(one.face));
        EXPECT_NEAR(one.density, view.density(one.face, one.point), 1e-9 * one.density);
        ++drawn[one.face];
        share[one.face] += 1 / (one.density * tree[one.face].shape.area);
      }
      // The integral of 1 over a face is its area, however points are drawn.
      for (const auto& [face, sum] : share)
        if (drawn[face] > 400) {
          EXPECT_NEAR(sum / kDraws, 1, 6 / std::sqrt(drawn[face])) << count;
        }
    }
  }
}

// A lamp as large as a hand close by, in a cluster of many others, beside a bright wall of lamps far away.
TEST(EmitterView, FindsASmallNearLamp) {
  Scene scene = by_hand::empty_scene(Sides::one);
  const auto add_lamp = [&](double x, double y, double z, double size) {
    by_hand::add(scene, "lamp", {{x, y, z}, {x, y + size, z}, {x + size, y + size, z}, {x + size, y, z}},
                 by_hand::kLight);
  };
  add_lamp(0.1, 0.1, 0.1, 0.05);
  for (int k = 0; k < 40; ++k) add_lamp(3 + 0.3 * k, 0.2 * k, 4, 0.05);
  for (int k = 0; k < 10; ++k) add_lamp(-20 + k, 5, 30, 1);
  scene = test_scenes::finished(std::move(scene));
  const NodeTree tree(scene);
  const RayScene ray_scene(scene, 1);
  const EmitterDraw emitters(tree, ray_scene);
  const ReceivingPoint at{{0, 0, 0}, {0, 0, 1}, emitters.region_of(static_cast<NodeId>(tree.clusters()))};
  const EmitterView view(emitters, at);
  double all = 0, near = 0;
  for (std::size_t id = tree.clusters(); id < tree.whole(); ++id) {
    const double F = point_to_polygon(at.position, at.normal, corners(tree.outline(static_cast<NodeId>(id))));
    all += F;
    near += tree[static_cast<NodeId>(id)].shape.centroid.z < 1 ? F : 0;
  }
  int found = 0;
  constexpr int kDraws = 10000;
  SobolPoints numbers(1);
  for (int k = 0; k < kDraws; ++k) {
    const auto [u, v, choice, unused] = numbers.next();
    found += view.draw(choice, u, v).point.z < 1 ? 1 : 0;
  }
  EXPECT_GT(near / all, 0.3);
  EXPECT_NEAR(found / double{kDraws}, near / all, 0.15 * near / all);
}

// Of a lamp of which most is below the horizon what rises above it is found, and counts alike.
TEST(EmitterView, FindsWhatRisesAboveTheHorizon) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "lamp", {{5, -0.6, -1}, {5, -0.6, 0.3}, {5, 0.7, 0.3}, {5, 0.7, -1}}, by_hand::kLight);
  scene = test_scenes::finished(std::move(scene));
  const NodeTree tree(scene);
  const RayScene ray_scene(scene, 1);
  const EmitterDraw emitters(tree, ray_scene);
  const auto lamp = static_cast<NodeId>(tree.clusters());
  const ReceivingPoint at{{0, 0, 0}, {0, 0, 1}, emitters.region_of(lamp)};
  const double F = point_to_polygon(at.position, at.normal, corners(tree.outline(lamp)));
  ASSERT_GT(F, 1e-5);
  const EmitterView view(emitters, at);
  ASSERT_FALSE(view.empty());
  double sum = 0, largest = 0;
  constexpr int kDraws = 1 << 12;
  SobolPoints numbers(1);
  for (int k = 0; k < kDraws; ++k) {
    const auto [u, v, choice, unused] = numbers.next();
    const DrawnEmitter drawn = view.draw(choice, u, v);
    const glm::dvec3 way = drawn.point - at.position;
    const double squared = glm::dot(way, way);
    const double kernel = std::max(0.0, way.z) * way.x / (std::numbers::pi * squared * squared);
    sum += kernel / drawn.density;
    largest = std::max(largest, kernel / drawn.density);
  }
  EXPECT_NEAR(sum / kDraws, F, 0.01 * F);
  EXPECT_LT(largest, 20 * F);
}

}  // namespace
}  // namespace fluxel
