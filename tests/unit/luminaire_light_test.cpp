#include "optics/luminaire_light.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/sampling.hpp"
#include "formfactor/even_points.hpp"
#include "optics/element_luminaires.hpp"
#include "optics/luminaire_escape.hpp"
#include "tests/closed_forms/polygons.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel::luminaire_light_test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr MaterialId kDarkLamp{1};

/// A floor of 4 x 4 m around the origin, normal z, and lamps of 100 cd that look down from 2 m.
struct Room {
  Scene scene = by_hand::empty_scene(Sides::one);

  Room() {
    scene.materials[index(kDarkLamp)].E = Rgb(0);
    by_hand::add(scene, "floor", {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
    scene.intensities.push_back({{0}, {0, kPi}, {100, 100}});
    IntensityTable cosine{{0}, {}, {}};
    constexpr int kSteps = 2000;
    for (int g = 0; g <= kSteps; ++g) {
      cosine.gamma.push_back(kPi / 2 * g / kSteps);
      cosine.intensity.push_back(100 * std::cos(cosine.gamma.back()));
    }
    cosine.intensity.back() = 0;
    scene.intensities.push_back(cosine);
  }

  Luminaire& add(const glm::dvec3& position, std::uint32_t table) {
    Luminaire& lamp = scene.luminaires.emplace_back();
    lamp.position = position;
    lamp.intensity = table;
    return lamp;
  }

  /// The middle of both halves.
  [[nodiscard]] Rgb irradiance(const glm::dvec3& at, double rays_a_spread = 1e5,
                               std::uint64_t seed = 7) const {
    const Scene made = test_scenes::finished(scene);
    const RayScene rays(made, 1);
    std::uint64_t traced = 0;
    const auto halves = LuminaireLight(rays).irradiance_halves({at, {0, 0, 1}}, rays_a_spread, seed, traced);
    return 0.5 * (halves[0] + halves[1]);
  }
};

TEST(LuminaireLight, OfAPointIsCosineOverSquare) {
  Room room;
  room.add({0, 0, 2}, 0).scale = {1, 0.5, 0};
  for (const double x : {0.0, 0.5, 1.9}) {
    const double squared = 4 + x * x;
    const Rgb found = room.irradiance({x, 0, 0});
    EXPECT_NEAR(found.r, 100 * 2 / (squared * std::sqrt(squared)), 1e-9);
    EXPECT_NEAR(found.g, found.r / 2, 1e-12);
    EXPECT_EQ(found.b, 0);
  }
}

TEST(LuminaireLight, FollowsTheTableAboutItsAxes) {
  Room room;
  // Twice as much towards C = 90 degrees as elsewhere; nothing above.
  room.scene.intensities.push_back(
      {{0, kPi / 2, kPi, 3 * kPi / 2, 2 * kPi},
       {0, kPi / 4, kPi / 2},
       {100, 100, 100, 100, 200, 200, 100, 100, 100, 100, 100, 100, 100, 100, 100}});
  Luminaire& lamp = room.add({0, 0, 1}, 2);
  lamp.ahead = {0, 1, 0};
  const double towards = 1 / std::pow(2.0, 1.5);  // cosine over square at 45 degrees
  EXPECT_NEAR(room.irradiance({0, 1, 0}).r, 100 * towards, 1e-9);
  // C = 90 degrees is cross(ahead, aim) = (0, 1, 0) x (0, 0, -1) = (-1, 0, 0).
  EXPECT_NEAR(room.irradiance({-1, 0, 0}).r, 200 * towards, 1e-9);
  EXPECT_NEAR(room.irradiance({1, 0, 0}).r, 100 * towards, 1e-9);
  room.scene.luminaires[0].aim = {0, 0, 1};
  EXPECT_EQ(room.irradiance({1, 0, 0}).r, 0);
}

TEST(LuminaireLight, OfADiffuseOpeningIsThatOfADiffusePatch) {
  Room room;
  Luminaire& lamp = room.add({0.3, 0, 2}, 1);
  lamp.size = {1.2, 0.6};
  const closed_forms::Polygon opening{{-0.3, -0.3, 2}, {-0.3, 0.3, 2}, {0.9, 0.3, 2}, {0.9, -0.3, 2}};
  const double exitance = kPi * 100 / (1.2 * 0.6);
  for (const glm::dvec3 at : {glm::dvec3(0.3, 0, 0), glm::dvec3(-1.5, 1, 0), glm::dvec3(0.3, 0, 1.5)}) {
    const double expected = exitance * closed_forms::point_to_polygon(at, {0, 0, 1}, opening);
    EXPECT_NEAR(room.irradiance(at, 1e9).r, expected, 2e-3 * expected) << at.x;
  }
}

TEST(LuminaireLight, OfADiscIsThatOfADisc) {
  Room room;
  Luminaire& lamp = room.add({0, 0, 1}, 1);
  lamp.size = {1, 1};
  lamp.round = true;
  // On the axis of a disc of radius R: F = R^2 / (R^2 + h^2).
  const double exitance = kPi * 100 / (kPi * 0.25);
  EXPECT_NEAR(room.irradiance({0, 0, 0}, 1e9).r, exitance * 0.25 / 1.25, 2e-3 * exitance * 0.2);
}

TEST(LuminaireLight, WhatStandsBetweenHidesIt) {
  Room room;
  room.add({0, 0, 2}, 0);
  by_hand::add(room.scene, "plate", {{-0.5, -0.5, 1}, {0.5, -0.5, 1}, {0.5, 0.5, 1}, {-0.5, 0.5, 1}});
  EXPECT_EQ(room.irradiance({0.9, 0, 0}).r, 0);
  EXPECT_GT(room.irradiance({1.1, 0, 0}).r, 0);
  // Half of the opening is seen past the plate's edge: at (1, 0, 0) what has x > 0 at z = 2.
  room.scene.luminaires[0].size = {0.2, 0.2};
  const double half = room.irradiance({1, 0, 0}, 1e9).r;
  room.scene.patches.pop_back();
  // The nearer half, whose centre is 0.05 m nearer: d log(h / r^3) / dx = 3 x / r^2 = 0.6 / m.
  EXPECT_NEAR(half, 0.5 * 1.03 * room.irradiance({1, 0, 0}, 1e9).r, 0.005 * half);
}

/// Far more than are asked one by one, of very different distances.
void add_many(Room& room) {
  for (int k = 0; k < 200; ++k)
    room.add({-1.9 + 0.019 * k, 0.5 * std::sin(k), 1 + 0.01 * k}, static_cast<std::uint32_t>(k % 2));
}

TEST(LuminaireLight, OfManyIsTheSumOfAll) {
  Room one, many;
  add_many(many);
  const glm::dvec3 at(0.4, -0.2, 0);
  double sum = 0;
  for (const Luminaire& lamp : many.scene.luminaires) {
    one.scene.luminaires = {lamp};
    sum += one.irradiance(at).r;
  }
  // What little ones bring together is drawn.
  constexpr int kSeeds = 64;
  double drawn = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) drawn += many.irradiance(at, 1e9, seed).r / kSeeds;
  EXPECT_NEAR(drawn, sum, 2e-3 * sum);
}

TEST(LuminaireLight, DrawnRaysAreRightOnAverage) {
  Room room;
  add_many(room);
  for (Luminaire& lamp : room.scene.luminaires) lamp.size = {0.1, 0.3};
  const glm::dvec3 at(0.4, -0.2, 0);
  const double expected = room.irradiance(at, 1e9).r;
  const Scene made = test_scenes::finished(room.scene);
  const RayScene rays(made, 1);
  const LuminaireLight light(rays);
  constexpr std::size_t kDraws = 4096;
  SobolPoints points(3);
  double drawn = 0;
  for (std::size_t k = 0; k < kDraws; ++k) {
    const auto [u, v, choice, unused] = points.next();
    drawn += light.draw({at, {0, 0, 1}}, choice, u, v).light.r / kDraws;
  }
  EXPECT_NEAR(drawn, expected, 0.01 * expected);
  std::uint64_t traced = 0;
  EXPECT_NEAR(light.sampled_irradiance({at, {0, 0, 1}}, 1000, 5, traced).r, expected, 0.02 * expected);
  EXPECT_GE(traced, 1000u) << "five each, and what makes a lattice of them";
  EXPECT_LE(traced, 1200u);
  traced = 0;
  double few = 0;
  for (std::uint64_t seed = 0; seed < 512; ++seed)
    few += light.sampled_irradiance({at, {0, 0, 1}}, 8, random_bits(seed), traced).r / 512;
  EXPECT_NEAR(few, expected, 0.02 * expected);
  EXPECT_LE(traced, 512u * 8);
}

TEST(LuminaireLight, OfNearOpeningsNoPointsAreSeen) {
  // Two rays a luminaire would say 0.2 to 3 times the light so near to a long one.
  Room room;
  add_many(room);
  room.scene.luminaires.resize(12);
  for (Luminaire& lamp : room.scene.luminaires) lamp.size = {1.2, 0.1};
  for (const double height : {0.05, 0.2, 0.5}) {
    const Luminaire& lamp = room.scene.luminaires[3];
    const glm::dvec3 at = lamp.position + height * lamp.aim + 0.1 * lamp.ahead;
    const double expected = room.irradiance(at, 1e9).r;
    ASSERT_GT(expected, 0);
    const Scene made = test_scenes::finished(room.scene);
    const RayScene rays(made, 1);
    std::uint64_t traced = 0;
    EXPECT_NEAR(LuminaireLight(rays).sampled_irradiance({at, {0, 0, 1}}, 32, 0, traced).r, expected,
                0.03 * expected)
        << height;
  }
}

TEST(LuminaireLight, OfAnElementIsItsMean) {
  Room room;
  room.add({0, 0, 2}, 0);
  const Scene made = test_scenes::finished(room.scene);
  const RayScene rays(made, 1);
  ElementMesh mesh;
  mesh.elements.push_back(
      {.centroid = {0, 0, 0}, .area = 16, .normal = {0, 0, 1}, .patch = PatchId{0}, .sides = kFront});
  mesh.outlines.push_back({{glm::vec3(-2, -2, 0), {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}, 4});
  // A sixth of the sphere, as the floor is the face of a cube around the lamp.
  const std::vector<Rgb> found = first_light_of_elements(rays, mesh, 0, 1, false, 1);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].r, 100 * 4 * kPi / 6 / 16, 0.05 * 13);
}

TEST(LuminaireEscape, WhatMissesTheFloorEscapes) {
  Room room;
  room.add({0, 0, 2}, 0).scale = {1, 2, 0};
  const Scene made = test_scenes::finished(room.scene);
  const LuminaireEscape found = luminaire_escape(RayScene(made, 1));
  const double whole = 400 * kPi;
  EXPECT_NEAR(found.flux.r, whole, 1e-9 * whole);
  EXPECT_NEAR(found.flux.g, 2 * whole, 1e-9 * whole);
  EXPECT_GT(found.error.r, 0);
  EXPECT_LT(found.error.r, 0.01 * whole);
  EXPECT_NEAR(found.escaped.r, whole * 5 / 6, 3 * found.error.r);
  EXPECT_EQ(found.dark, Rgb(0));
}

TEST(LuminaireEscape, RaysStartAndGoIndependently) {
  // Of an opening along x over the edge of the floor, from points beyond which half of the light flies away.
  Room room;
  room.add({2, 0, 1e-4}, 0).size = {1, 0.01};
  const Scene made = test_scenes::finished(room.scene);
  const LuminaireEscape found = luminaire_escape(RayScene(made, 1));
  const double whole = 400 * kPi;
  EXPECT_NEAR(found.escaped.r, 0.75 * whole, 0.01 * whole);
}

TEST(LuminaireEscape, WhatMeetsTheBackIsDark) {
  Room room;
  room.add({0, 0, -2}, 1).aim = {0, 0, 1};
  const Scene made = test_scenes::finished(room.scene);
  const LuminaireEscape found = luminaire_escape(RayScene(made, 1));
  EXPECT_NEAR(found.flux.r, 100 * kPi, 0.01);
  // The form factor from a point of a surface to the square.
  const double F =
      closed_forms::point_to_polygon({0, 0, -2}, {0, 0, 1}, {{-2, -2, 0}, {-2, 2, 0}, {2, 2, 0}, {2, -2, 0}});
  // 4096 even points are nearer than a third of the standard error of random ones.
  EXPECT_NEAR(found.dark.r, 100 * kPi * F, 100 * kPi * std::sqrt(F * (1 - F) / 4096) / 3);
  EXPECT_NEAR(found.dark.r + found.escaped.r, found.flux.r, 1e-9 * found.flux.r) << "all rays carry the same";
}

}  // namespace
}  // namespace fluxel::luminaire_light_test
