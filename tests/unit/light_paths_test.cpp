#include "reference/light_paths.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/sampling.hpp"
#include "scene/scene_input.hpp"
#include "tests/closed_forms/points.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using closed_forms::Rectangle;

/// What many paths from one point find, of one channel.
struct Found {
  double mean = 0, error = 0, largest = 0, squares = 0;
};

Found irradiance(const LightPaths& paths, const LitPoint& at, int channel = 0, int randomisations = 16,
                 std::uint32_t samples = 1024) {
  Found found;
  double squares = 0;
  for (int r = 0; r < randomisations; ++r) {
    std::vector<PathStart> starts;
    for (std::uint32_t index = 0; index < samples; ++index) {
      OwenSobol numbers(random_bits(static_cast<std::uint64_t>(r)), index);
      const auto [a, b, u, v] = numbers.next();
      starts.push_back({at, {u, v}, numbers});
    }
    std::vector<Rgb> values(samples);
    std::uint64_t rays = 0;
    paths.irradiance(starts, values, rays);
    double sum = 0;
    for (const Rgb& colour : values) {
      const double value = colour[channel];
      sum += value;
      found.largest = std::max(found.largest, value);
      found.squares += value * value / (randomisations * static_cast<double>(samples));
    }
    const double mean = sum / samples;
    found.mean += mean / randomisations;
    squares += mean * mean;
  }
  found.error =
      std::sqrt(std::max(0.0, squares / randomisations - found.mean * found.mean) / (randomisations - 1));
  return found;
}

/// What a ray meets.
LightPaths::Seen seen(const LightPaths& paths, const glm::dvec3& eye, const glm::dvec3& direction) {
  const Ray ray{eye, direction};
  LightPaths::Seen seen;
  paths.first_seen({&ray, 1}, {&seen, 1});
  return seen;
}

void expect_mean(const Found& found, double exact, double most_error) {
  EXPECT_LT(std::abs(found.mean - exact), 4 * found.error + 1e-6) << found.mean << " for " << exact;
  EXPECT_LT(found.error, most_error);
}

/// A black lamp that emits (1, 1, 1) over [0, 1]^2 at z = 1, downward.
Scene lamp(Sides sides = Sides::one) {
  Scene scene = by_hand::empty_scene(sides);
  by_hand::add(scene, "lamp", {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}, by_hand::kLight);
  return test_scenes::finished(std::move(scene));
}

TEST(LightPaths, IrradianceUnderALamp) {
  const Scene scene = lamp();
  const RayScene rays(scene, 1);
  const LightPaths paths(rays);
  for (const glm::dvec3& at : {glm::dvec3(0.5, 0.5, 0), glm::dvec3(2, -1, 0), glm::dvec3(0.1, 0.3, 0.97)}) {
    const double gap = 1 - at.z;
    const Rectangle lit{0 - at.x, 1 - at.x, 0 - at.y, 1 - at.y};
    expect_mean(irradiance(paths, {at, {0, 0, 1}}), closed_forms::point_to_parallel_rectangle(lit, gap),
                1e-3);
    EXPECT_EQ(irradiance(paths, {at, {0, 0, -1}}).largest, 0) << "it turns away";
  }
}

// From far away single precision knows a point to less than rays are lifted off the lamp by.
TEST(LightPaths, ALampIsSeenFromFarAway) {
  const Scene scene = lamp();
  const RayScene rays(scene, 1);
  const LightPaths paths(rays);
  for (const double distance : {100.0, 1e4}) {
    const double exact = closed_forms::point_to_parallel_rectangle({-0.5, 0.5, -0.5, 0.5}, distance);
    const Found found = irradiance(paths, {{0.5, 0.5, 1 - distance}, {0, 0, 1}});
    EXPECT_NEAR(found.mean, exact, 1e-4 * exact) << distance;
  }
}

// Rays that meet a far lamp are rare: what is left to them is missing, unseen, until one does.
TEST(LightPaths, FewPathsFindTheLightOfAFarLamp) {
  const Scene scene = lamp();
  const RayScene rays(scene, 1);
  const LightPaths paths(rays);
  const double exact = closed_forms::point_to_parallel_rectangle({-0.5, 0.5, -0.5, 0.5}, 12);
  const Found found = irradiance(paths, {{0.5, 0.5, -11}, {0, 0, 1}}, 0, 16, 4);
  // The balance heuristic leaves 0.2 % to the rays.
  EXPECT_NEAR(found.mean, exact, 2e-4 * exact);
}

// Without the weights a drawn point's light grows with 1 / distance^2, and its variance has no bound.
TEST(LightPaths, LightHasABoundAtAnEdgeOfTheLamp) {
  const Scene scene = lamp();
  const RayScene rays(scene, 1);
  const LightPaths paths(rays);
  const glm::dvec3 below(0.5, 0.5, 1 - 1e-4);
  const Found close = irradiance(paths, {below, {0, 0, 1}});
  expect_mean(close, 1, 1e-3);
  for (const double distance : {1e-2, 1e-3, 1e-5}) {
    // On a wall that the lamp's edge touches, as far below it.
    const LitPoint at{{0, 0.5, 1 - distance}, {1, 0, 0}};
    const Rectangle lit{0, 1, -0.5, 0.5};
    const Found found = irradiance(paths, at);
    expect_mean(found, closed_forms::point_to_perpendicular_rectangle(distance, lit), 3e-3);
    EXPECT_LT(found.largest, 2) << "a drawn point and a ray, each below the lamp's exitance";
    EXPECT_LT(found.squares, 1);
  }
}

TEST(LightPaths, OneSidedLampsHaveDarkBacksThatHide) {
  for (const Sides sides : {Sides::one, Sides::two}) {
    Scene scene = lamp(sides);
    const PatchId upper =
        by_hand::add(scene, "upper", {{0, 0, 3}, {0, 1, 3}, {1, 1, 3}, {1, 0, 3}}, by_hand::kLight);
    scene.pieces.push_back({scene.patch(upper).outline, upper});
    scene.extent = 3;
    const RayScene rays(scene, 1);
    const LightPaths paths(rays);
    EXPECT_EQ(irradiance(paths, {{0.5, 0.5, 0.5}, {0, 0, -1}}).largest, 0);
    const Found between = irradiance(paths, {{0.5, 0.5, 2}, {0, 0, -1}});
    EXPECT_EQ(between.largest, 0) << "light goes from the front alone";
    expect_mean(irradiance(paths, {{0.5, 0.5, 0}, {0, 0, 1}}),
                closed_forms::point_to_parallel_rectangle({-0.5, 0.5, -0.5, 0.5}, 1), 1e-3);
  }
}

TEST(LightPaths, BacksEmitHeat) {
  Scene scene = lamp(Sides::two);
  scene.materials[1].thermal = ThermalSurface{};
  const RayScene rays(scene, 1);
  const double F = closed_forms::point_to_parallel_rectangle({-0.5, 0.5, -0.5, 0.5}, 1);
  expect_mean(irradiance(LightPaths(rays), {{0.5, 0.5, 2}, {0, 0, -1}}), F, 1e-3);
}

/// A lamp in the plane of a ceiling and of another lamp's, as the reader makes it: the second lamp is of the
/// same size and comes later.
Scene lamp_in_ceiling(bool two_lamps) {
  SceneInput input;
  input.name = "ceiling";
  input.materials = {{"white", Rgb(0.5), Rgb(0), std::nullopt, std::nullopt},
                     {"lamp", Rgb(0), Rgb(1), std::nullopt, std::nullopt},
                     {"other lamp", Rgb(0), Rgb(7), std::nullopt, std::nullopt},
                     {"black", Rgb(0), Rgb(0), std::nullopt, std::nullopt}};
  input.groups = {"all"};
  const auto square = [&](double low, double high, std::uint32_t material) {
    input.polygons.push_back(
        {{{low, low, 1}, {low, high, 1}, {high, high, 1}, {high, low, 1}}, MaterialId{material}, GroupId{0}});
  };
  square(-2, 3, 0);
  square(0, 1, 1);
  if (two_lamps) square(0, 1, 2);
  input.polygons.push_back({{{-2, -2, 0}, {3, -2, 0}, {3, 3, 0}, {-2, 3, 0}}, MaterialId{3}, GroupId{0}});
  SceneSettings settings;
  settings.sides = Sides::one;
  return build_scene(input, settings);
}

TEST(LightPaths, OfCoincidentPatchesTheFirstLampIsSeen) {
  for (const bool two_lamps : {false, true}) {
    const Scene scene = lamp_in_ceiling(two_lamps);
    const RayScene rays(scene, 1);
    const LightPaths paths(rays);
    for (const double x : {0.5, 1.7}) {
      const LitPoint at{glm::dvec3(x, 0.5, 0) - scene.origin, {0, 0, 1}};
      expect_mean(irradiance(paths, at), closed_forms::point_to_parallel_rectangle({-x, 1 - x, -0.5, 0.5}, 1),
                  1e-3);
    }
    const glm::dvec3 eye = glm::dvec3(0.4, 0.7, 0.3) - scene.origin;
    EXPECT_EQ(seen(paths, eye, {0.1, 0, 1}).side->E.r, 1);
    EXPECT_EQ(seen(paths, eye, {2, 0, 1}).side->E.r, 0) << "the ceiling is not lit";
  }
}

// Every path brings 1 on average, after as many reflections as it has.
TEST(LightPaths, AFurnaceShinesEverywhere) {
  for (const double rho : {0.2, 0.9}) {
    Scene scene = test_scenes::unit_cube();
    scene.materials[0].rho = Rgb(rho, 0.5 * rho, 0);
    scene.materials[0].E = Rgb(1) - scene.materials[0].rho;
    const RayScene rays(scene, 1);
    const LightPaths paths(rays);
    for (int channel = 0; channel < 2; ++channel)
      expect_mean(irradiance(paths, {{0.1, 0.2, -0.3}, {0.6, 0, 0.8}}, channel), 1, 1e-2);
  }
}

/// The same light at all points.
class SameEverywhere final : public FinishedLight {
 public:
  explicit SameEverywhere(double light) : light_(light) {}
  [[nodiscard]] Rgb reflected(PatchId /*patch*/, bool /*front*/, const glm::dvec3& /*point*/) const override {
    return Rgb(light_);
  }

 private:
  double light_;
};

// Whatever a solution says: on average roulette adds nothing.
TEST(LightPaths, ASolutionWhereRouletteEndsThemMovesNoMean) {
  for (const double rho : {0.2, 0.9}) {
    Scene scene = test_scenes::unit_cube();
    scene.materials[0].rho = Rgb(rho);
    scene.materials[0].E = Rgb(1 - rho);
    const RayScene rays(scene, 1);
    const LitPoint at{{0.1, 0.2, -0.3}, {0.6, 0, 0.8}};
    const SameEverywhere truth(rho), wrong(3), dark(0);
    const Found with_truth = irradiance(LightPaths(rays, &truth), at);
    expect_mean(with_truth, 1, 3e-3);
    expect_mean(irradiance(LightPaths(rays, &wrong), at), 1, 5e-2);
    const Found with_nothing = irradiance(LightPaths(rays, &dark), at);
    expect_mean(with_nothing, 1, 2e-2);
    EXPECT_LT(with_truth.squares - 1, 0.8 * (with_nothing.squares - 1)) << "the truth takes variance away";
  }
}

/// Light on one wall of the unit cube alone, x = 0.5 from inside.
class OnOneWall final : public FinishedLight {
 public:
  explicit OnOneWall(const Scene& scene) {
    for (std::uint32_t k = 0; k < scene.patches.size(); ++k)
      if (std::abs(scene.patches[k].normal.x) > 0.9 && scene.patches[k].outline.corner[0].x > 0)
        wall_ = PatchId{k};
    outline_ = scene.patch(wall_).outline;
  }
  [[nodiscard]] Rgb reflected(PatchId patch, bool /*front*/, const glm::dvec3& /*point*/) const override {
    return patch == wall_ ? Rgb(0.7) : Rgb(0);
  }
  [[nodiscard]] std::optional<DrawnPoint> draw(double u, double v) const override {
    return DrawnPoint{surface_point(outline_, u, v), wall_, true};
  }
  [[nodiscard]] double density(PatchId patch, bool front, const glm::dvec3& /*point*/) const override {
    return patch == wall_ && front ? 1 : 0;
  }

 private:
  PatchId wall_ = kNoPatch;
  Outline<glm::dvec3> outline_;
};

// In a furnace of lamps that reflect, where rays go by the cosine, to lamps and to what a solution says.
TEST(LightPaths, RaysGuidedByASolutionMoveNoMean) {
  for (const double rho : {0.2, 0.9}) {
    Scene scene = test_scenes::unit_cube();
    scene.materials[0].rho = Rgb(rho);
    scene.materials[0].E = Rgb(1 - rho);
    const RayScene rays(scene, 1);
    const OnOneWall guide(scene);
    const LightPaths paths(rays, &guide);
    expect_mean(irradiance(paths, {{0.1, 0.2, -0.3}, {0.6, 0, 0.8}}), 1, 2e-2);
    expect_mean(irradiance(paths, {{0.1, 0.2, -0.3}, {-1, 0, 0}}), 1, 2e-2);
  }
}

TEST(LightPaths, PathsEndWhereNothingIsAbsorbed) {
  Scene scene = test_scenes::unit_cube();
  scene.materials[0].rho = Rgb(1);
  scene.materials[0].E = Rgb(1);
  const RayScene rays(scene, 1);
  const LightPaths paths(rays);
  std::vector<PathStart> starts;
  for (std::uint32_t index = 0; index < 20; ++index)
    starts.push_back({{{0, 0, -0.5}, {0, 0, 1}}, {0.5, 0.5}, OwenSobol(3, index)});
  std::vector<Rgb> found(starts.size());
  std::uint64_t count = 0;
  paths.irradiance(starts, found, count);
  for (const Rgb& light : found) EXPECT_GT(light.r, 0);
  EXPECT_LT(count, 400000u);
}

TEST(LightPaths, NothingIsLitWithoutALamp) {
  const Scene scene = test_scenes::unit_cube();
  const RayScene rays(scene, 1);
  const LightPaths paths(rays);
  EXPECT_EQ(irradiance(paths, {{0, 0, -0.5}, {0, 0, 1}}).largest, 0);
  EXPECT_EQ(seen(paths, {0, 0, 5}, {0, 0, 1}).side, nullptr) << "it looks away";
}

// Bounce by bounce side by side, packets full or not: each path finds what it does alone.
TEST(LightPaths, AWaveIsAsPathAfterPath) {
  Scene scene = test_scenes::unit_cube();
  scene.materials[0].rho = Rgb(0.8, 0.5, 0.2);
  scene.materials[0].E = Rgb(1, 2, 3);
  const RayScene rays(scene, 1);
  const LightPaths paths(rays);
  std::vector<PathStart> starts;
  for (std::uint32_t index = 0; index < 333; ++index) {
    OwenSobol numbers(7, index);
    const auto [x, y, u, v] = numbers.next();
    starts.push_back({{{x - 0.5, y - 0.5, -0.5}, {0, 0, 1}}, {u, v}, numbers});
  }
  std::vector<Rgb> wave(starts.size());
  std::uint64_t of_wave = 0, of_paths = 0;
  paths.irradiance(starts, wave, of_wave);
  for (std::size_t k = 0; k < starts.size(); ++k) {
    Rgb alone(0);
    paths.irradiance({&starts[k], 1}, {&alone, 1}, of_paths);
    EXPECT_EQ(alone, wave[k]) << k;
  }
  EXPECT_EQ(of_wave, of_paths);
}

// Half of a luminaire's light falls on a spot of the ceiling just above it, which sends 2 rho I / h^2 to what
// is the height h below: as much as comes straight for rho = 0.5. Paths alone do not find the spot.
TEST(LightPaths, ASpotOnTheCeilingIsFoundFromTheLuminaire) {
  for (const double gap : {1e-4, 1e-3}) {
    Scene scene = by_hand::empty_scene(Sides::one);
    scene.materials[0].rho = Rgb(0.5, 0.25, 0);
    by_hand::add(scene, "ceiling", {{-2, -2, 2}, {-2, 2, 2}, {2, 2, 2}, {2, -2, 2}});
    scene.intensities.push_back({{0}, {0, std::numbers::pi}, {100, 100}});
    scene.luminaires.emplace_back().position = {0, 0, 2 - gap};
    const Scene made = test_scenes::finished(std::move(scene));
    const RayScene rays(made, 1);
    const LightPaths paths(rays);
    const LitPoint below{{0, 0, 0}, {0, 0, 1}};
    const double straight = 100 / ((2 - gap) * (2 - gap)), spot = 2 * 100 / 4.0;
    for (int channel = 0; channel < kChannels; ++channel) {
      const Found found = irradiance(paths, below, channel);
      EXPECT_NEAR(found.mean, straight + made.materials[0].rho[channel] * spot, 4 * found.error + 0.4) << gap;
      EXPECT_LT(found.error, 1) << gap;
    }
  }
}

// A spot that paths find, too, counts once: of an opening of 0.4 m, 2 cm below the ceiling. Seen from 2 m it
// sends as a point does to within 2 %.
TEST(LightPaths, ASpotThatPathsFindCountsOnce) {
  Scene scene = by_hand::empty_scene(Sides::one);
  scene.materials[0].rho = Rgb(0.5);
  by_hand::add(scene, "ceiling", {{-2, -2, 2}, {-2, 2, 2}, {2, 2, 2}, {2, -2, 2}});
  scene.intensities.push_back({{0}, {0, std::numbers::pi}, {100, 100}});
  Luminaire& lamp = scene.luminaires.emplace_back();
  lamp.position = {0, 0, 1.98};
  lamp.size = {0.4, 0.4};
  const Scene made = test_scenes::finished(std::move(scene));
  const RayScene rays(made, 1);
  const Found found = irradiance(LightPaths(rays), {{0, 0, 0}, {0, 0, 1}}, 0, 16, 1 << 14);
  const double straight = 100 / (1.98 * 1.98), spot = 0.5 * 2 * 100 / 4.0;
  EXPECT_NEAR(found.mean, straight + spot, 0.02 * (straight + spot) + 4 * found.error);
  EXPECT_LT(found.error, 1);
}

}  // namespace
}  // namespace fluxel
