#include "scene/merge_patches.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "scene/contact_pairs.hpp"
#include "scene/cut_patches.hpp"
#include "scene_by_hand.hpp"

namespace fluxel {
namespace {

using namespace by_hand;

constexpr GroupId kGroup{0};

Scene one_group(Sides sides = Sides::one) {
  Scene scene = empty_scene(sides);
  scene.groups = {"wall"};
  return scene;
}

PatchId add_to_group(Scene& scene, const std::vector<glm::dvec3>& corner, MaterialId material = kWhite) {
  const PatchId patch = add(scene, "", corner, material);
  scene.groups.pop_back();
  scene.patches.back().group = kGroup;
  return patch;
}

/// As to_patches leaves a scene.
void merge(Scene& scene) {
  for (const Patch& patch : scene.patches) {
    for (const glm::dvec3& x : corners(patch.outline))
      scene.extent = std::max({scene.extent, std::abs(x.x), std::abs(x.y), std::abs(x.z)});
  }
  PatchMesh mesh = connect_patches(scene);
  const auto components = mesh.components.size();
  merge_patches(scene, mesh);
  EXPECT_EQ(mesh.components.size(), components);
  EXPECT_EQ(mesh.component.size(), scene.patches.size());
  EXPECT_EQ(mesh.outlines.size(), scene.patches.size());
  std::size_t held = 0;
  for (const PatchComponent& component : mesh.components) {
    EXPECT_TRUE(std::ranges::is_sorted(component.patches));
    held += component.patches.size();
  }
  EXPECT_EQ(held, scene.patches.size());
}

std::vector<glm::dvec3> corners_of(const Patch& patch) {
  const PolygonView view = corners(patch.outline);
  return {view.begin(), view.end()};
}

double total_area(const Scene& scene) {
  double sum = 0;
  for (const Patch& patch : scene.patches) sum += patch.area;
  return sum;
}

enum class Diagonals { rising, random, both };

/// Cells of a sheared grid with random spacings in a random plane, each cut into triangles, in random order.
/// `wanted` says which cells there are.
Scene triangle_grid(std::size_t columns, std::size_t rows, Diagonals diagonals, std::mt19937& random,
                    const std::function<bool(std::size_t, std::size_t)>& wanted) {
  std::uniform_real_distribution<double> step(0.05, 0.3);
  std::vector<double> x{0}, y{0};
  while (x.size() <= columns) x.push_back(x.back() + step(random));
  while (y.size() <= rows) y.push_back(y.back() + step(random));
  const glm::dquat turn = random_rotation(random);
  const auto point = [&](double s, double t) { return turn * glm::dvec3(s + 0.3 * t - 1, t - 1, 0.5); };
  std::vector<std::vector<glm::dvec3>> triangles;
  for (std::size_t i = 0; i < columns; ++i) {
    for (std::size_t j = 0; j < rows; ++j) {
      if (!wanted(i, j)) continue;
      const auto a = point(x[i], y[j]), b = point(x[i + 1], y[j]), c = point(x[i + 1], y[j + 1]),
                 d = point(x[i], y[j + 1]), m = 0.25 * (a + b + c + d);
      if (diagonals == Diagonals::both) {
        triangles.insert(triangles.end(), {{a, b, m}, {b, c, m}, {c, d, m}, {d, a, m}});
      } else if (diagonals == Diagonals::rising || random() % 2 == 0) {
        triangles.insert(triangles.end(), {{a, b, c}, {a, c, d}});
      } else {
        triangles.insert(triangles.end(), {{a, b, d}, {b, c, d}});
      }
    }
  }
  std::ranges::shuffle(triangles, random);
  Scene scene = one_group();
  for (auto& triangle : triangles) {
    std::rotate(triangle.begin(), triangle.begin() + random() % 3, triangle.end());
    add_to_group(scene, triangle);
  }
  return scene;
}

TEST(MergePatches, HalvesOfAQuadGiveItBack) {
  Scene scene = one_group();
  const std::vector<glm::dvec3> quad{{1, 0, 0}, {1, 1, 0.25}, {0, 1, 0.25}, {0, 0, 0}};
  add(scene, "lamp", {{5, 5, 5}, {6, 5, 5}, {5, 6, 5}}, kLight);
  add_to_group(scene, {quad[0], quad[1], quad[2]});
  add_to_group(scene, {quad[0], quad[2], quad[3]});
  add(scene, "lamp", {{8, 5, 5}, {9, 5, 5}, {8, 6, 5}}, kLight);
  merge(scene);
  ASSERT_EQ(scene.patches.size(), 3u);
  EXPECT_EQ(corners_of(scene.patches[1]), quad);
  EXPECT_DOUBLE_EQ(scene.patches[1].area, area(quad));
  EXPECT_TRUE(scene.patches[1].normal == glm::normalize(area_vector(quad)));
  EXPECT_EQ(scene.patches[1].group, kGroup);
  EXPECT_EQ(scene.patches[0].material, kLight);
  EXPECT_EQ(scene.patches[2].outline.corner[0].x, 8);
  EXPECT_EQ(scene.statistics.merged_patches, 1u);
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_EQ(scene.notes[0], "2 coplanar polygons merged into 1");
}

TEST(MergePatches, AWallIsOneHoweverItIsDivided) {
  std::mt19937 random(5);
  for (const Diagonals diagonals : {Diagonals::rising, Diagonals::random, Diagonals::both}) {
    for (int trial = 0; trial < 10; ++trial) {
      Scene scene = triangle_grid(9, 7, diagonals, random, [](auto, auto) { return true; });
      const double before = total_area(scene);
      const std::size_t read = scene.patches.size();
      merge(scene);
      ASSERT_EQ(scene.patches.size(), 1u);
      EXPECT_EQ(scene.patches[0].outline.corners, 4u);
      EXPECT_NEAR(scene.patches[0].area, before, 1e-12);
      EXPECT_EQ(scene.statistics.merged_patches, read - 1);
    }
  }
}

TEST(MergePatches, ATriangleOfTrianglesIsOne) {
  const glm::dvec3 a{0, 0, 0}, b{4, 0, 1}, c{1, 3, 2}, ab = 0.5 * (a + b), bc = 0.5 * (b + c),
                                                       ca = 0.5 * (c + a);
  Scene scene = one_group();
  add_to_group(scene, {ab, bc, ca});
  add_to_group(scene, {a, ab, ca});
  add_to_group(scene, {ab, b, bc});
  add_to_group(scene, {ca, bc, c});
  merge(scene);
  ASSERT_EQ(scene.patches.size(), 1u);
  EXPECT_EQ(scene.patches[0].outline.corners, 3u);
  EXPECT_DOUBLE_EQ(scene.patches[0].area, area(std::array{a, b, c}));
}

TEST(MergePatches, AWallWithAWindowIsFourAndAnLIsTwo) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 10; ++trial) {
    Scene window = triangle_grid(9, 7, Diagonals::rising, random,
                                 [](auto i, auto j) { return i < 3 || i > 5 || j < 2 || j > 3; });
    Scene ell = triangle_grid(8, 8, Diagonals::rising, random, [](auto i, auto j) { return i < 3 || j < 3; });
    for (Scene* scene : {&window, &ell}) {
      const double before = total_area(*scene);
      merge(*scene);
      EXPECT_EQ(scene->patches.size(), scene == &window ? 4u : 2u);
      EXPECT_NEAR(total_area(*scene), before, 1e-12);
    }
  }
}

TEST(MergePatches, RandomShapesKeepTheirAreaPlaceByPlace) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 30; ++trial) {
    std::vector<bool> there(100);
    std::generate(there.begin(), there.end(), [&] { return random() % 4 != 0; });
    const auto diagonals = std::array{Diagonals::rising, Diagonals::random,
                                      Diagonals::both}[static_cast<std::size_t>(trial) % 3];
    Scene scene = triangle_grid(10, 10, diagonals, random, [&](auto i, auto j) { return there[10 * i + j]; });
    const Scene before = scene;
    merge(scene);
    EXPECT_LT(scene.patches.size(), before.patches.size());
    EXPECT_NEAR(total_area(scene), total_area(before), 1e-12);
    // Each of the old ones is held by one of the new ones, whole: they share no more than its area.
    for (const Patch& old : before.patches) {
      const glm::dvec3 middle = centroid(corners(old.outline));
      EXPECT_EQ(std::ranges::count_if(scene.patches,
                                      [&](const Patch& patch) {
                                        const PolygonView outline = corners(patch.outline);
                                        for (std::size_t i = 0; i < outline.size(); ++i) {
                                          if (edge_plane(outline, i, patch.normal).distance(middle) < 0)
                                            return false;
                                        }
                                        return true;
                                      }),
                1);
    }
  }
}

/// Two triangles that make a unit square, the second changed.
std::size_t patches_of_halves(const std::function<void(Scene&)>& change) {
  Scene scene = one_group();
  scene.groups.emplace_back("other");
  add(scene, "far", {{50, 50, 50}, {51, 50, 50}, {50, 51, 50}}, kLight);
  add_to_group(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
  add_to_group(scene, {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  change(scene);
  Patch& last = scene.patches.back();
  const glm::dvec3 vector = area_vector(corners(last.outline));
  last.area = glm::length(vector);
  last.normal = vector / last.area;
  merge(scene);
  return scene.patches.size() - 1;
}

TEST(MergePatches, DifferentPatchesStayTwo) {
  EXPECT_EQ(patches_of_halves([](Scene&) {}), 1u);
  EXPECT_EQ(patches_of_halves([](Scene& s) { s.patches[2].group = GroupId{1}; }), 2u);
  EXPECT_EQ(patches_of_halves([](Scene& s) { s.patches[2].material = kLight; }), 2u);
  EXPECT_EQ(patches_of_halves([](Scene& s) {
              auto& corner = s.patches[2].outline.corner;
              std::reverse(corner.begin(), corner.begin() + 3);  // faces the other way
            }),
            2u);
  // No parallelogram, and no corner that falls away.
  EXPECT_EQ(patches_of_halves([](Scene& s) { s.patches[2].outline.corner[2] = {0, 0.9, 0}; }), 2u);
  EXPECT_EQ(patches_of_halves([](Scene& s) { s.patches[2].outline.corner[2] = {0, 1.0001, 0}; }), 2u);
  // Folded.
  EXPECT_EQ(patches_of_halves([](Scene& s) { s.patches[2].outline.corner[2] = {0, 1, 1e-3}; }), 2u);
  // A duplicate, which covers the other.
  EXPECT_EQ(patches_of_halves([](Scene& s) { s.patches.push_back(s.patches[2]); }), 3u);
}

TEST(MergePatches, TheRoundingOfFilesDoesNotMatter) {
  // Corners 1e-7 off, where the scene's diagonal is 87 m and single precision tells 6e-6 m apart.
  EXPECT_EQ(patches_of_halves([](Scene& s) { s.patches[2].outline.corner[2] += 1e-7; }), 1u);
}

TEST(MergePatches, AThirdPatchAtTheEdgeCutsTheSumInstead) {
  Scene scene = one_group();
  add_to_group(scene, {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}});
  add_to_group(scene, {{0, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  add_to_group(scene, {{0, 0, 0}, {2, 2, 0}, {2, 2, 1}, {0, 0, 1}});
  merge(scene);
  ASSERT_EQ(scene.patches.size(), 2u);
  cut_patches(scene, connect_patches(scene), true);
  EXPECT_EQ(scene.statistics.cut_patches, 1u);
  EXPECT_EQ(pieces_of(scene, PatchId{0}).size(), 2u);
  EXPECT_DOUBLE_EQ(piece_area(scene, PatchId{0}), 4);
}

TEST(MergePatches, BothFacesOfASheetAreMerged) {
  Scene scene = one_group();
  const std::vector<glm::dvec3> quad{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  add_to_group(scene, {quad[0], quad[1], quad[2]});
  add_to_group(scene, {quad[0], quad[2], quad[3]});
  add_to_group(scene, {quad[2], quad[1], quad[0]});
  add_to_group(scene, {quad[3], quad[2], quad[0]});
  merge(scene);
  ASSERT_EQ(scene.patches.size(), 2u);
  EXPECT_DOUBLE_EQ(glm::dot(scene.patches[0].normal, scene.patches[1].normal), -1);
}

TEST(MergePatches, ABumpStaysABump) {
  Scene scene = one_group();
  add(scene, "far", {{500, 500, 500}, {501, 500, 500}, {500, 501, 500}}, kLight);
  const std::vector<glm::dvec3> base{{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 0}};
  const glm::dvec3 top{0.05, 0.05, 2e-4};
  for (std::size_t i = 0; i < 4; ++i) add_to_group(scene, {base[i], base[(i + 1) % 4], top});
  EXPECT_GT(0.4 * contact_tolerance(scene), top.z);
  merge(scene);
  EXPECT_EQ(scene.patches.size(), 1u + 4);
}

TEST(MergePatches, ArcsAreNotStraightenedLittleByLittle) {
  // A fan whose rim has 1000 corners: each is within the tolerance of the line between its neighbours.
  Scene scene = one_group();
  const auto rim = [](int k) { return glm::dvec3(std::cos(1e-4 * k), std::sin(1e-4 * k), 0); };
  std::vector<glm::dvec3> points;
  for (int k = 0; k < 1000; ++k) {
    points.push_back(rim(k));
    add_to_group(scene, {{0, 0, 0}, rim(k), rim(k + 1)});
  }
  merge(scene);
  EXPECT_LT(scene.patches.size(), 600u);
  for (const glm::dvec3& point : points) {
    double outside = std::numeric_limits<double>::infinity();
    for (const Patch& patch : scene.patches) {
      const PolygonView outline = corners(patch.outline);
      double farthest = 0;
      for (std::size_t i = 0; i < outline.size(); ++i)
        farthest = std::max(farthest, -edge_plane(outline, i, patch.normal).distance(point));
      outside = std::min(outside, farthest);
    }
    EXPECT_LE(outside, 1e-6);
  }
}

TEST(MergePatches, CurvedSurfacesStayCurved) {
  // The segments of the thin tube lie within what counts as touching of their neighbours' planes: in a scene
  // of this size they could be taken for flat, were it not for their tilt.
  for (const double size : {1.0, 0.05}) {
    Scene scene = one_group();
    constexpr int kSegments = 100;
    add(scene, "far", {{500, 500, 500}, {501, 500, 500}, {500, 501, 500}}, kLight);
    const auto rim = [&](int k, double z) {
      const double phi = 2 * std::numbers::pi * k / kSegments;
      return size * glm::dvec3(std::cos(phi), std::sin(phi), z);
    };
    for (int k = 0; k < kSegments; ++k) {
      const auto a = rim(k, 0), b = rim(k + 1, 0), c = rim(k + 1, 2), d = rim(k, 2);
      add_to_group(scene, {a, b, c});
      add_to_group(scene, {a, c, d});
    }
    const double step = 2 * std::numbers::pi / kSegments;
    EXPECT_EQ(0.5 * contact_tolerance(scene) > step * step * size, size < 1);
    merge(scene);
    // Each segment's two triangles are one, and no two segments are.
    EXPECT_EQ(scene.patches.size(), 1u + kSegments) << size;
  }
}

}  // namespace
}  // namespace fluxel
