#include "scene/to_patches.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <random>

#include "core/error.hpp"
#include "scene/triangulate.hpp"

namespace fluxel {
namespace {

using Corners = std::vector<glm::dvec3>;

SceneInput scene_of(const std::vector<Corners>& polygons) {
  SceneInput input;
  input.name = "test";
  input.file = "test.obj";
  input.groups = {"first", "second"};
  input.materials.emplace_back().name = "white";
  for (const Corners& corners : polygons) {
    input.polygons.push_back({corners, MaterialId{0}, GroupId{input.polygons.empty() ? 0u : 1u}});
  }
  return input;
}

double total_area(const Scene& scene) {
  double sum = 0;
  for (const Patch& patch : scene.patches) sum += patch.area;
  return sum;
}

bool has_note(const Scene& scene, const std::string& words) {
  return std::any_of(scene.notes.begin(), scene.notes.end(),
                     [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

std::string refusal_of(const SceneInput& input) {
  try {
    static_cast<void>(to_patches(input, {}));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

const Corners kSquareCorners = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};

TEST(ToPatches, RecentresInDoublePrecision) {
  const double far_away = 1e6;
  const Scene scene =
      to_patches(scene_of({{{far_away, 0, 0}, {far_away + 1e-3, 0, 0}, {far_away, 4e-3, 0}}}), {});
  EXPECT_NEAR(scene.origin.x, far_away + 0.5e-3, 1e-9);
  EXPECT_EQ(scene.origin.y, 2e-3);
  EXPECT_EQ(scene.extent, 2e-3);
  ASSERT_EQ(scene.patches.size(), 1u);
  // 1e6 has steps of 1.2e-10 m: the edges are that exact, and so is what is made of them.
  EXPECT_NEAR(scene.patches[0].area, 2e-6, 1e-12);
  EXPECT_EQ(scene.patches[0].outline.corner[0].y, -2e-3);
}

TEST(ToPatches, KeepsTrianglesAndParallelograms) {
  const Scene scene = to_patches(
      scene_of({{{0, 0, 0}, {2, 0, 0}, {3, 1, 1}, {1, 1, 1}}, {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}}}), {});
  ASSERT_EQ(scene.patches.size(), 2u);
  EXPECT_EQ(scene.patches[0].outline.corners, 4u);
  EXPECT_DOUBLE_EQ(scene.patches[0].area, 2 * std::numbers::sqrt2);
  EXPECT_NEAR(glm::distance(scene.patches[0].normal, glm::normalize(glm::dvec3(0, -1, 1))), 0, 1e-15);
  EXPECT_EQ(scene.patches[1].outline.corners, 3u);
  EXPECT_EQ(scene.patches[1].normal, glm::dvec3(-1, 0, 0));
  EXPECT_EQ(scene.patches[1].area, 0.5);
  EXPECT_EQ(index(scene.patches[0].group), 0u);
  EXPECT_EQ(index(scene.patches[1].group), 1u);
  EXPECT_EQ(scene.statistics.faces_read, 2u);
  EXPECT_EQ(scene.statistics.nonplanar_faces, 0u);
  EXPECT_TRUE(scene.notes.empty());
}

TEST(ToPatches, ParallelogramToleranceIsOfTheLongestEdge) {
  const auto corners = [](double off) { return Corners{{0, 0, 0}, {10, 0, 0}, {10 + off, 1, 0}, {0, 1, 0}}; };
  EXPECT_EQ(to_patches(scene_of({corners(0.9e-5)}), {}).patches.size(), 1u);
  EXPECT_EQ(to_patches(scene_of({corners(1.1e-5)}), {}).patches.size(), 2u);
}

TEST(ToPatches, SplitsConvexQuadAlongItsFirstDiagonal) {
  const Scene scene = to_patches(scene_of({{{0, 0, 0}, {4, 0, 0}, {3, 1, 0}, {0, 1, 0}}}), {});
  ASSERT_EQ(scene.patches.size(), 2u);
  EXPECT_EQ(scene.patches[0].outline.corner[2] + scene.origin, glm::dvec3(3, 1, 0));
  EXPECT_EQ(scene.patches[1].outline.corner[1] + scene.origin, glm::dvec3(3, 1, 0));
  EXPECT_DOUBLE_EQ(total_area(scene), 3.5);
  EXPECT_EQ(scene.statistics.nonplanar_faces, 0u);
}

TEST(ToPatches, SplitsNonplanarQuadAlongItsFirstDiagonalAndNotesIt) {
  for (const double lift : {0.3, -0.3}) {
    const Corners bent = {{0, 0, 0}, {1, 0, 0}, {1, 1, lift}, {0, 1, 0}};
    const Scene scene = to_patches(scene_of({bent}), {});
    ASSERT_EQ(scene.patches.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(scene.patches[k].outline.corner[0] + scene.origin, bent[0]);
      EXPECT_NEAR(glm::distance(scene.patches[k].outline.corner[k == 0 ? 2 : 1] + scene.origin, bent[2]), 0,
                  1e-15);
    }
    EXPECT_EQ(scene.statistics.nonplanar_faces, 1u);
    EXPECT_TRUE(has_note(scene, "1 face not planar")) << scene.notes[0];
    EXPECT_TRUE(has_note(scene, "'first'"));
  }
}

TEST(ToPatches, NonplanarConcaveQuadKeepsItsFirstDiagonal) {
  const Corners arrowhead = {{-1, 0, 0}, {0, 0.5, 0.4}, {1, 0, 0}, {0, 2, 0}};
  const Scene scene = to_patches(scene_of({arrowhead}), {});
  ASSERT_EQ(scene.patches.size(), 2u);
  EXPECT_EQ(scene.patches[0].outline.corner[1] + scene.origin, arrowhead[1]);
  EXPECT_EQ(scene.patches[0].outline.corner[2] + scene.origin, arrowhead[2]);
  EXPECT_EQ(scene.patches[1].outline.corner[2] + scene.origin, arrowhead[3]);
}

TEST(ToPatches, ConcaveQuadStaysInside) {
  // An arrowhead whose second corner is reflex, so that the first diagonal lies outside.
  const Scene scene = to_patches(scene_of({{{0, 2, 0}, {-1, 0, 0}, {0, 0.5, 0}, {1, 0, 0}}}), {});
  EXPECT_DOUBLE_EQ(total_area(scene), 1.5);
  const Scene turned = to_patches(scene_of({{{-1, 0, 0}, {0, 0.5, 0}, {1, 0, 0}, {0, 2, 0}}}), {});
  ASSERT_EQ(turned.patches.size(), 2u);
  EXPECT_DOUBLE_EQ(total_area(turned), 1.5);
  for (const Patch& patch : turned.patches) EXPECT_EQ(patch.normal, glm::dvec3(0, 0, 1));
}

TEST(ToPatches, ConcavePolygonCoversItsOwnArea) {
  // A comb in a slanted plane: the area is the shoelace sum in the plane.
  const Corners comb = {{0, 0, 0}, {5, 0, 0}, {5, 3, 0}, {4, 3, 0}, {4, 1, 0},
                        {3, 1, 0}, {3, 3, 0}, {2, 3, 0}, {2, 1, 0}, {0, 1, 0}};
  Corners slanted;
  for (const glm::dvec3& p : comb) slanted.emplace_back(p.x, 0.6 * p.y, 0.8 * p.y);
  const Scene scene = to_patches(scene_of({slanted}), {});
  EXPECT_LE(scene.patches.size(), 8u);
  EXPECT_NEAR(total_area(scene), 9, 1e-14);
  for (const Patch& patch : scene.patches) {
    EXPECT_NEAR(glm::distance(patch.normal, glm::dvec3(0, -0.8, 0.6)), 0, 1e-14);
  }
}

TEST(ToPatches, RandomStarsAreCoveredOnce) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> radius(0.2, 1.0);
  for (int round = 0; round < 200; ++round) {
    Corners star;
    const int corners = 5 + round % 40;
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * std::numbers::pi * i / corners, r = radius(random);
      star.emplace_back(r * std::cos(angle), r * std::sin(angle), 3);
    }
    const double area = glm::length(vector_area(star));
    const Scene scene = to_patches(scene_of({star}), {});
    EXPECT_EQ(scene.patches.size(), star.size() - 2);
    // All triangles face the front, so an overlap would make their sum too large.
    for (const Patch& patch : scene.patches) EXPECT_GT(patch.normal.z, 0.999);
    EXPECT_NEAR(total_area(scene), area, 1e-12);
    EXPECT_FALSE(has_note(scene, "crosses"));
  }
}

TEST(ToPatches, PolygonWithABridgeToItsHole) {
  const Corners ring = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                        {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};
  const Scene scene = to_patches(scene_of({ring}), {});
  EXPECT_NEAR(total_area(scene), 12, 1e-14);
  EXPECT_FALSE(has_note(scene, "crosses"));
}

TEST(ToPatches, CollinearCornersOfAPolygonLoseNothing) {
  const Scene scene = to_patches(
      scene_of({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}}}), {});
  EXPECT_DOUBLE_EQ(total_area(scene), 4);
  EXPECT_EQ(scene.statistics.degenerate_faces, 0u);
}

TEST(ToPatches, NonplanarPolygonIsTriangulatedInItsMeanPlane) {
  const Scene scene = to_patches(scene_of({{{1, 0, 0},
                                            {0.5, 0.9, 0.1},
                                            {-0.5, 0.9, -0.1},
                                            {-1, 0, 0.1},
                                            {-0.5, -0.9, -0.1},
                                            {0.5, -0.9, 0}}}),
                                 {});
  EXPECT_EQ(scene.patches.size(), 4u);
  EXPECT_EQ(scene.statistics.nonplanar_faces, 1u);
  for (const Patch& patch : scene.patches) EXPECT_GT(patch.normal.z, 0.9);
}

TEST(ToPatches, CrossingOutlineIsNoted) {
  const Corners folded = {{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, -1, 0}, {0, 2, 0}};
  EXPECT_TRUE(has_note(to_patches(scene_of({folded}), {}), "outline crosses itself"));
  const Corners overlapping = {{2, 3, 0}, {0, 3, 0}, {2, 1, 0}, {3, 3, 0}, {1, 3, 0}};
  EXPECT_TRUE(has_note(to_patches(scene_of({overlapping}), {}), "outline crosses itself"));
  Corners pentagram;  // every corner turns left, and none is an ear
  for (int i = 0; i < 5; ++i) {
    pentagram.emplace_back(std::cos(0.8 * i * std::numbers::pi), std::sin(0.8 * i * std::numbers::pi), 0);
  }
  EXPECT_TRUE(has_note(to_patches(scene_of({pentagram}), {}), "outline crosses itself"));
}

TEST(ToPatches, DropsDegenerateFacesAndCountsThem) {
  const Corners repeated = {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 0, 0}};
  const Corners collinear = {{0, 0, 0}, {1, 1, 0}, {2, 2, 0}};
  const Corners sliver = {{0, 0, 0}, {2, 0, 0}, {1, 1e-14, 0}};  // 1e-14 m2 of a diagonal squared of 8 m2
  const Corners thin = {{0, 0, 0}, {2, 0, 0}, {1, 1e-12, 0}};    // 1e-12 m2 stays
  const Scene scene = to_patches(scene_of({kSquareCorners, repeated, collinear, sliver, thin}), {});
  EXPECT_EQ(scene.statistics.faces_read, 5u);
  EXPECT_EQ(scene.statistics.degenerate_faces, 3u);
  EXPECT_EQ(scene.patches.size(), 2u);
  EXPECT_TRUE(has_note(scene, "3 faces without an area"));
  EXPECT_TRUE(has_note(scene, "'second'"));
}

TEST(ToPatches, SaysWhichFacesAreTooSmallForTheSceneAndWhy) {
  // The diagonal is 1.5e9 m, its square times 1e-14 22,500 m2, which is a square of 150 m.
  const Corners sky = {{0, 0, 0}, {1e9, 0, 0}, {1e9, 1e9, 0.5e9}, {0, 1e9, 0.5e9}};
  SceneInput input = scene_of({sky, kSquareCorners, kSquareCorners, kSquareCorners});
  input.groups.emplace_back("lamp");
  input.materials.emplace_back().Ke = Rgb(1);
  for (const std::size_t k : {2u, 3u}) {
    input.polygons[k].group = GroupId{2};
    input.polygons[k].material = MaterialId{1};
  }
  input.geometry = {{.file = "sky.obj", .metres_per_unit = 1000}};
  const Scene scene = to_patches(input, {});
  EXPECT_EQ(scene.statistics.degenerate_faces, 3u);
  ASSERT_EQ(scene.notes.size(), 1u);
  for (const char* words :
       {"3 faces are too small", "2 of them emitting", "of group 'lamp' (2, emitting), 'second' (1)",
        "below 2.25e+04 m2, a square of 150 m", "1e-7 of the 1.5e+09 m", "group 'first' reaches farthest",
        "metres_per_unit right? It is 1000 for sky.obj"})
    EXPECT_TRUE(has_note(scene, words)) << words << " is not in: " << scene.notes[0];
  EXPECT_EQ(scene.lost_emitters, scene.notes[0]);
  input.materials[1].Ke = Rgb(0);
  EXPECT_EQ(to_patches(input, {}).lost_emitters, "");
}

TEST(ToPatches, RepeatedCornersAreTakenOnce) {
  const Scene scene = to_patches(scene_of({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}},
                                           {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}}}),
                                 {});
  ASSERT_EQ(scene.patches.size(), 2u);
  EXPECT_EQ(scene.patches[0].outline.corners, 3u);
  EXPECT_EQ(scene.patches[1].outline.corners, 4u);
  EXPECT_EQ(scene.statistics.degenerate_faces, 0u);
}

TEST(ToPatches, MaterialsGetExitanceAndSides) {
  SceneInput input = scene_of({kSquareCorners, kSquareCorners, kSquareCorners});
  input.materials[0].Ke = {1, 2, 3};
  input.materials.push_back({"set", Rgb{0.25}, Rgb{7}, Rgb{5}, Sides::one});
  input.materials.push_back({"both", Rgb{0.25}, Rgb{0}, {}, Sides::two});
  input.polygons[1].material = MaterialId{1};
  input.polygons[2].material = MaterialId{2};
  SceneSettings settings;
  settings.sides = Sides::two;
  settings.ke = KeMeaning::radiance;
  const Scene two = to_patches(input, settings);
  EXPECT_EQ(two.materials[0].E, std::numbers::pi * Rgb(1, 2, 3));
  EXPECT_EQ(two.materials[1].E, Rgb(5));
  EXPECT_EQ(two.materials[1].rho, Rgb(0.25));
  EXPECT_EQ(two.patches[0].sides, kFront | kBack);
  EXPECT_EQ(two.patches[1].sides, kFront);

  settings.sides = Sides::one;
  settings.ke = KeMeaning::exitance;
  const Scene one = to_patches(input, settings);
  EXPECT_EQ(one.materials[0].E, Rgb(1, 2, 3));
  EXPECT_EQ(one.patches[0].sides, kFront);
  EXPECT_EQ(one.patches[2].sides, kFront | kBack);
}

TEST(ToPatches, RejectsScenesWithoutAnArea) {
  EXPECT_NE(refusal_of(scene_of({})).find("test.obj: holds no face with an area, of 0"), std::string::npos);
  const Corners point = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
  const Corners line = {{1, 2, 3}, {2, 3, 4}, {3, 4, 5}};
  EXPECT_NE(refusal_of(scene_of({point})).find("holds no face with an area, of 1"), std::string::npos);
  EXPECT_NE(refusal_of(scene_of({line})).find("holds no face with an area, of 1"), std::string::npos);
}

TEST(ToPatches, RejectsScenesTooLargeOrTooSmall) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {2e9, -2e9, inf, nan}) {
    const std::string message = refusal_of(scene_of({{{0, 0, 0}, {1, 0, 0}, {0, bad, 0}}}));
    EXPECT_NE(message.find("too large"), std::string::npos) << message;
    EXPECT_NE(message.find("metres_per_unit"), std::string::npos) << message;
  }
  const std::string message = refusal_of(scene_of({{{0, 0, 0}, {1e-11, 0, 0}, {0, 1e-11, 0}}}));
  EXPECT_NE(message.find("m across"), std::string::npos) << message;
}

}  // namespace
}  // namespace fluxel
