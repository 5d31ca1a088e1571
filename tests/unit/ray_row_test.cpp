#include "hierarchy/ray_row.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "formfactor/even_points.hpp"
#include "formfactor/view_factor.hpp"
#include "hierarchy/emitter_draw.hpp"
#include "subdivision/piece_finder.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

/// Plates of which every third one shines, some more than others.
Scene shining_plates() {
  Scene scene = test_scenes::random_plates(60, 0.2, Sides::two, 7);
  for (std::size_t k = 0; k < scene.patches.size(); k += 3) scene.patches[k].material = by_hand::kLight;
  return scene;
}

/// The cluster that has this area [m2]; none: kNoNode.
NodeId cluster_of(const NodeTree& tree, double area) {
  double any = 0;
  for (NodeId id = 0; id < tree.clusters(); ++id)
    if (std::abs(tree[id].shape.area - area) < 1e-9 && tree[tree.random_face(id, any)].front) return id;
  return kNoNode;
}

TEST(EmitterDraw, TellsTheChanceOfWhatItDraws) {
  const Scene scene = shining_plates();
  const NodeTree tree(scene);
  const RayScene ray_scene(scene, 1);
  const EmitterDraw emitters(tree, ray_scene);
  std::mt19937 random(3);
  for (const glm::dvec3 from : {glm::dvec3(0), glm::dvec3(1, 0.5, -2), glm::dvec3(30, 0, 0)}) {
    // As from anywhere else.
    const RegionId region = emitters.region_of(static_cast<NodeId>(tree.clusters() + random() % 100));
    const ReceivingPoint at{from, glm::normalize(glm::dvec3(1, 2, 3)), region};
    double all = 0;
    std::map<NodeId, double> chance;
    for (std::size_t id = tree.clusters(); id < tree.whole(); ++id) {
      const auto face = static_cast<NodeId>(id);
      const double of_face = emitters.chance(face, at);
      if (!emitters.emits(face)) {
        EXPECT_EQ(of_face, 0);
      }
      chance[face] = of_face;
      all += of_face;
    }
    EXPECT_NEAR(all, 1, 1e-12);
    std::map<NodeId, int> drawn;
    constexpr int kDraws = 40000;
    for (int k = 0; k < kDraws; ++k) {
      const DrawnEmitter found =
          emitters.draw(at, test_scenes::uniform(random, 0, 1), test_scenes::uniform(random, 0, 1),
                        test_scenes::uniform(random, 0, 1));
      EXPECT_NEAR(found.density, emitters.density(found.face, found.point, at), 1e-9 * found.density);
      ++drawn[found.face];
    }
    for (const auto& [face, of_face] : chance)
      EXPECT_NEAR(drawn[face], kDraws * of_face, 5 * std::sqrt(kDraws * of_face) + 1) << face;
  }
}

TEST(EmitterDraw, LampsOfOtherRoomsAreAskedLess) {
  // Two rooms side by side, each with a lamp below its ceiling, as far from the wall between them.
  Scene scene = by_hand::empty_scene(Sides::two);
  for (const double x : {0.0, 4.0}) {
    by_hand::add_box(scene, "room", {x, 0, 0}, {x + 3.99, 3, 3}, false);
    by_hand::add(scene, "lamp", {{x + 1.5, 1, 2.9}, {x + 1.5, 2, 2.9}, {x + 2.5, 2, 2.9}, {x + 2.5, 1, 2.9}},
                 by_hand::kLight);
  }
  scene = test_scenes::finished(std::move(scene));
  const RayScene ray_scene(scene, 1);
  const NodeTree tree(scene);
  const EmitterDraw emitters(tree, ray_scene);
  std::vector<NodeId> lamps;
  NodeId floor = kNoNode;
  for (std::size_t id = tree.clusters(); id < tree.whole(); ++id) {
    const auto face = static_cast<NodeId>(id);
    const FlatShape& shape = tree[face].shape;
    if (emitters.emits(face)) lamps.push_back(face);
    if (floor == kNoNode && shape.centroid.z < 0.1 && shape.normal.z > 0 && shape.centroid.x < 4)
      floor = face;
  }
  ASSERT_EQ(lamps.size(), 2u);
  ASSERT_NE(floor, kNoNode);
  if (tree[lamps[0]].shape.centroid.x > 4) std::swap(lamps[0], lamps[1]);
  // On the floor of the first room, about as far from both.
  const ReceivingPoint at{{3.9, 1.5, 0}, {0, 0, 1}, emitters.region_of(floor)};
  const double own = emitters.chance(lamps[0], at), other = emitters.chance(lamps[1], at);
  EXPECT_GT(own, 4 * other);
  EXPECT_GT(other, 0);  // what a few rays say is not for certain
}

// Points of equal areas would count for up to a thousand times their mean.
TEST(EmitterDraw, OfANearLampDrawsCountAlike) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "lamp", {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, by_hand::kLight);
  scene = test_scenes::finished(std::move(scene));
  const RayScene ray_scene(scene, 1);
  const NodeTree tree(scene);
  const EmitterDraw emitters(tree, ray_scene);
  const auto lamp = static_cast<NodeId>(tree.clusters());
  // The kernel of a point on a wall that stands on the lamp.
  const glm::dvec3 from{0.1, 0.2, 0.03}, normal{1, 0, 0};
  double sum = 0, largest = 0;
  constexpr int kDraws = 1 << 12;
  SobolPoints numbers(1);
  for (int k = 0; k < kDraws; ++k) {
    const auto [u, v, choice, unused] = numbers.next();
    const DrawnEmitter drawn = emitters.draw({from, normal, 0}, choice, u, v);
    const glm::dvec3 way = drawn.point - from;
    const double squared = glm::dot(way, way);
    const double kernel =
        std::max(0.0, glm::dot(way, normal)) * -way.z / (std::numbers::pi * squared * squared);
    sum += kernel / drawn.density;
    largest = std::max(largest, kernel / drawn.density);
  }
  const double F = point_to_polygon(from, normal, corners(tree.outline(lamp)));
  EXPECT_NEAR(sum / kDraws, F, 2e-3 * F);
  EXPECT_LT(largest, 5 * F);
}

/// A floor of 8 x 1 m below a lamp over its one end.
struct LitFloor {
  Scene scene;
  NodeId floor = kNoNode;

  LitFloor() {
    scene = by_hand::empty_scene(Sides::one);
    by_hand::add(scene, "floor", {{0, 0, 0}, {8, 0, 0}, {8, 1, 0}, {0, 1, 0}});
    const PatchId lamp =
        by_hand::add(scene, "lamp", {{0.5, 0.25, 1}, {0.5, 0.75, 1}, {1, 0.75, 1}, {1, 0.25, 1}});
    scene.patches[index(lamp)].material = by_hand::kLight;
    scene = test_scenes::finished(std::move(scene));
  }
};

TEST(RayRow, OfAFaceTellsWhatALampSendsItAndHowThatVaries) {
  const LitFloor lit;
  const RayScene ray_scene(lit.scene, 1);
  const NodeTree tree(lit.scene);
  const RayLight light(ray_scene, tree);
  const NodeId floor = tree.face(0, true), lamp = tree.face(1, true);
  // A G = A_lamp F to the floor is what the floor gets of E.
  std::uint64_t rays = 0;
  const double G = tree[lamp].shape.area * [&] {
    double sum = 0;
    constexpr int kAcross = 200;
    for (int i = 0; i < kAcross; ++i)
      for (int j = 0; j < 25; ++j) {
        const glm::dvec3 at(8.0 * (i + 0.5) / kAcross, (j + 0.5) / 25, 0),
            way = tree[lamp].shape.centroid - at;
        sum += way.z * way.z / (std::numbers::pi * glm::dot(way, way) * glm::dot(way, way));
      }
    return sum * 8 / (kAcross * 25);
  }();
  const RayRow row = trace_row(light, floor, {4096, 1024}, rays);
  EXPECT_EQ(rays, 4096U + 1024U);
  const double E = mean_of_colours(tree.emission(lamp));
  EXPECT_NEAR(mean_of_colours(row.emitted[0]) * 8, E * G, 0.05 * E * G);
  // Nearly all of it falls on one half.
  const double mean = mean_of_colours(row.emitted[0]);
  const std::vector<double> nothing(row.ends.size(), 0.0);
  EXPECT_NEAR(deviation(tree, row, nothing), mean, 0.1 * mean);
}

// A sky that is as bright everywhere: of a row alone noise is left.
TEST(RayRow, WhereLightIsEvenNothingVaries) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add_box(scene, "room", {0, 0, 0}, {2, 2, 2}, false);
  scene = test_scenes::finished(std::move(scene));
  const RayScene ray_scene(scene, 1);
  const NodeTree tree(scene);
  const RayLight light(ray_scene, tree);
  std::uint64_t rays = 0;
  for (std::size_t id = tree.clusters(); id < tree.whole(); ++id) {
    const RayRow row = trace_row(light, static_cast<NodeId>(id), {}, rays);
    EXPECT_EQ(row.ends.size(), row.rays[0] + row.rays[1]);
    const std::vector<double> even(row.ends.size(), 3.0);
    EXPECT_NEAR(deviation(tree, row, even), 0, 1e-6);
  }
}

// A cube between a bright floor and a dark ceiling: the sides of its cluster receive as its faces do.
TEST(RayRow, AClusterReceivesByTheNormalsOfItsFaces) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "floor", {{-3, -3, -1}, {3, -3, -1}, {3, 3, -1}, {-3, 3, -1}});
  by_hand::add_box(scene, "cube", {-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}, true);
  scene = test_scenes::finished(std::move(scene));
  const RayScene ray_scene(scene, 1);
  const NodeTree tree(scene);
  const RayLight light(ray_scene, tree);
  const NodeId cube = cluster_of(tree, 6 * 0.04);
  ASSERT_NE(cube, kNoNode);
  std::vector<Rgb> bright(tree.size(), Rgb(0));
  bright[tree.face(0, true)] = Rgb(1);
  std::uint64_t rays = 0;
  const RayRow row = trace_row(light, cube, {4096, 1}, rays);
  std::array<double, kCubeSides> received{};
  for (const RayEnd& end : row.ends)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const glm::dvec3& normal = tree[end.from].shape.normal;
      const std::size_t side = cube_side(axis, normal);
      received[side] += cube_parts(normal)[axis] * bright[end.leaf].g / row.weight(side);
    }
  const std::size_t up = 4, down = 5;
  EXPECT_EQ(received[up], 0);
  EXPECT_GT(received[down], 0.85);  // a square of 6 m at 0.9 m
  // A face that stands alone, to one side.
  const RayRow of_face = trace_row(light, tree.face(3, true), {4096, 1}, rays);
  double of_one_side = 0;
  for (const RayEnd& end : of_face.ends) of_one_side += bright[end.leaf].g / 4096;
  EXPECT_GT(of_one_side, 0.25);
  for (std::size_t side = 0; side < 4; ++side) EXPECT_NEAR(received[side], of_one_side, 0.04) << side;
  // What its faces say one by one differs no more than their normals do.
  std::vector<double> reflected;
  for (const RayEnd& end : row.ends) reflected.push_back(bright[end.leaf].g);
  EXPECT_LT(deviation(tree, row, reflected), 0.05);
}

// Two plates side by side, below a lamp over their one end: their cluster gets what they get in the mean.
TEST(RayRow, OfAClusterStartsAllOverItsFaces) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "left", {{0, 0, 0}, {1, 0, 0}, {1, 8, 0}, {0, 8, 0}});
  by_hand::add(scene, "right", {{1, 0, 0}, {2, 0, 0}, {2, 8, 0}, {1, 8, 0}});
  by_hand::add(scene, "lamp", {{0.75, 0.5, 1}, {0.75, 1, 1}, {1.25, 1, 1}, {1.25, 0.5, 1}}, by_hand::kLight);
  scene = test_scenes::finished(std::move(scene));
  const RayScene ray_scene(scene, 1);
  const NodeTree tree(scene);
  const RayLight light(ray_scene, tree);
  const NodeId both = cluster_of(tree, 16);
  ASSERT_NE(both, kNoNode);
  std::uint64_t rays = 0;
  double of_faces = 0;
  for (const std::size_t piece : {0U, 1U})
    of_faces += 0.5 * trace_row(light, tree.face(piece, true), {4096, 1024}, rays).emitted[0].g;
  const RayRow row = trace_row(light, both, {4096, 1024}, rays);
  EXPECT_NEAR(row.emitted[4].g, of_faces, 0.1 * of_faces);
}

// A back is halved with its front, and says by which edge.
TEST(RayRow, BothSidesKnowTheEdgeThatTheyAreHalvedBy) {
  Scene scene = by_hand::empty_scene(Sides::two);
  by_hand::add(scene, "slat", {{0, 0, 0}, {0.1, 0, 0}, {0.1, 2, 0}, {0, 2, 0}});
  scene = test_scenes::finished(std::move(scene));
  NodeTree tree(scene);
  const NodeId front = tree.face(0, true), back = tree.face(0, false);
  const std::uint32_t edge = edge_to_halve(tree, front);
  EXPECT_EQ(edge % 2, 1U);
  const std::vector<Halving> halving{{back, edge_to_halve(tree, back)}};
  tree.split(halving);
  for (const NodeId side : {front, back}) EXPECT_EQ(edge_to_halve(tree, side), edge) << side;
}

// A floor under a lid: from above only the lid is seen of the two fronts, and their cluster has its light.
TEST(RayRow, TheInsideOfAClusterDoesNotCount) {
  Scene scene = by_hand::empty_scene(Sides::two);
  by_hand::add(scene, "sky", {{-9, -9, 5}, {-9, 9, 5}, {9, 9, 5}, {9, -9, 5}});
  by_hand::add(scene, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  by_hand::add(scene, "lid", {{0, 0, 0.02}, {1, 0, 0.02}, {1, 1, 0.02}, {0, 1, 0.02}});
  scene = test_scenes::finished(std::move(scene));
  const RayScene ray_scene(scene, 1);
  const NodeTree tree(scene);
  const RayLight light(ray_scene, tree);
  const NodeId both = cluster_of(tree, 2);
  ASSERT_NE(both, kNoNode);
  std::vector<double> bright(tree.size());
  bright[tree.face(0, true)] = bright[tree.face(0, false)] = 1;
  std::uint64_t rays = 0;
  const RayRow row = trace_row(light, both, {1024, 1}, rays);
  double upwards = 0;
  for (const RayEnd& end : row.ends)
    if (tree[end.from].shape.normal.z > 0) upwards += bright[end.leaf] / row.weight(4);
  // All sides that look up together would have half of what the lid has.
  EXPECT_GT(upwards, 0.7);
}

TEST(RayRow, WhatIsCoveredOfAFaceHardlyCounts) {
  Scene scene = by_hand::empty_scene(Sides::two);
  by_hand::add(scene, "lamp", {{-9, -9, 5}, {-9, 9, 5}, {9, 9, 5}, {9, -9, 5}}, by_hand::kLight);
  const PatchId floor = by_hand::add(scene, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  by_hand::add(scene, "lid", {{0, 0, 0.05}, {0.5, 0, 0.05}, {0.5, 1, 0.05}, {0, 1, 0.05}});
  scene = test_scenes::finished(std::move(scene));
  const RayScene ray_scene(scene, 1);
  const NodeTree tree(scene);
  const PieceFinder pieces(scene);
  const NodeId face = tree.face(pieces.find(floor, {0.75, 0.5, 0}), true);
  ASSERT_NEAR(tree[face].shape.area, 1, 1e-9);  // lid and floor are one piece each
  std::uint64_t rays = 0;
  const RayRow row = trace_row(RayLight(ray_scene, tree), face, {256, 1024}, rays);
  // All of the floor has 0.4 on average, what lies open 0.7.
  EXPECT_GT(row.emitted[0].r, 0.55);
}

TEST(RayRow, OfALampToo) {
  Scene scene = by_hand::empty_scene(Sides::two);
  by_hand::add(scene, "lamp", {{-9, -9, 5}, {-9, 9, 5}, {9, 9, 5}, {9, -9, 5}}, by_hand::kLight);
  by_hand::add(scene, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  by_hand::add(scene, "lid", {{0, 0, 0.02}, {1, 0, 0.02}, {1, 1, 0.02}, {0, 1, 0.02}});
  scene = test_scenes::finished(std::move(scene));
  const RayScene ray_scene(scene, 1);
  const NodeTree tree(scene);
  const NodeId both = cluster_of(tree, 2);
  ASSERT_NE(both, kNoNode);
  std::uint64_t rays = 0;
  const RayRow row = trace_row(RayLight(ray_scene, tree), both, {256, 1024}, rays);
  EXPECT_GT(row.emitted[4].r, 0.6);
}

}  // namespace
}  // namespace fluxel
