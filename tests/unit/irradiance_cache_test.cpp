#include "final_gather/irradiance_cache.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

/// A floor of 4 x 4 m around the origin and, where one is asked for, a wall on it along y.
Scene floor_scene(bool with_wall) {
  Scene scene = by_hand::empty_scene(Sides::two);
  by_hand::add(scene, "floor", {{-2, -2, 0}, {0, -2, 0}, {0, 2, 0}, {-2, 2, 0}});
  by_hand::add(scene, "floor", {{0, -2, 0}, {2, -2, 0}, {2, 2, 0}, {0, 2, 0}});
  if (with_wall) by_hand::add(scene, "wall", {{0, -2, 0}, {0, 2, 0}, {0, 2, 1}, {0, -2, 1}});
  return test_scenes::finished(std::move(scene));
}

SidePoint on_floor(double x, double y, bool front = true) {
  return {{x, y, 0}, {0, 0, front ? 1.0 : -1.0}, x < 0 ? 0U : 1U};
}

using Light = std::function<double(double, double)>;

/// On a shaken grid of 10 cm.
std::vector<IrradianceRecord> records_of(const Light& light, double noise = 0) {
  std::mt19937 random(1);
  std::vector<IrradianceRecord> records;
  for (double x = -1.95; x < 2; x += 0.1)
    for (double y = -1.95; y < 2; y += 0.1) {
      const double u = x + test_scenes::uniform(random, -0.03, 0.03),
                   v = y + test_scenes::uniform(random, -0.03, 0.03);
      const double off = std::sqrt(3.0) * noise * test_scenes::uniform(random, -1, 1);
      records.push_back({on_floor(u, v), Rgb(1, 2, 3) * (light(u, v) + off), 4 * noise * noise});
    }
  return records;
}

struct Errors {
  double true_error = 0, told = 0;  // root mean squares
};

Errors errors_of(const IrradianceCache& cache, const Light& light) {
  std::mt19937 random(2);
  Errors errors;
  constexpr int kPlaces = 2000;
  for (int k = 0; k < kPlaces; ++k) {
    const double x = test_scenes::uniform(random, -1.8, 1.8), y = test_scenes::uniform(random, -1.8, 1.8);
    const Interpolated found = cache.at(on_floor(x, y));
    EXPECT_GT(found.records, 3);
    const double d = mean_of_colours(found.irradiance) - 2 * light(x, y);
    errors.true_error += d * d / kPlaces;
    errors.told += (found.bias() * found.bias() + found.noise) / kPlaces;
  }
  return {std::sqrt(errors.true_error), std::sqrt(errors.told)};
}

TEST(IrradianceCache, EvenLightStaysEven) {
  const Scene scene = floor_scene(false);
  const RayScene ray_scene(scene, 1);
  const IrradianceCache cache(ray_scene, records_of([](double, double) { return 1.0; }), 1);
  for (const double x : {-1.99, -0.5, 0.0, 0.7, 1.99}) {
    const Interpolated found = cache.at(on_floor(x, 0.3));
    EXPECT_NEAR(found.irradiance.r, 1, 1e-12);
    EXPECT_NEAR(found.irradiance.b, 3, 1e-12);
    EXPECT_LT(found.bias(), 1e-12);
  }
  EXPECT_EQ(cache.at({{0.5, 0.5, 1}, {0, 0, 1}, 0}).records, 0);  // another plane
  EXPECT_EQ(cache.at(on_floor(0.5, 0.5, false)).records, 0);      // the other side
  EXPECT_EQ(cache.at({{0.5, 0.5, 0}, {1, 0, 0}, 0}).records, 0);  // another direction
  EXPECT_EQ(IrradianceCache(ray_scene, {}, 1).at(on_floor(0, 0)).records, 0);
}

// A slope is followed, up to the edge, but for what keeps slopes from growing.
TEST(IrradianceCache, FollowsSlopes) {
  const Scene scene = floor_scene(false);
  const RayScene ray_scene(scene, 1);
  const auto slope = [](double x, double y) { return 5 + x - 0.5 * y; };
  const IrradianceCache cache(ray_scene, records_of(slope), 2);
  EXPECT_LT(errors_of(cache, slope).true_error, 2e-3);  // of 0.2 from record to record
  EXPECT_NEAR(cache.at(on_floor(2, 0)).irradiance.r, slope(2, 0), 0.02);
}

TEST(IrradianceCache, TellsHowFarItIsOff) {
  const Scene scene = floor_scene(false);
  const RayScene ray_scene(scene, 1);
  const auto wave = [](double x, double y) { return 2 + std::cos(3 * x) * std::sin(3 * y); };
  for (const double noise : {0.0, 0.02, 0.1}) {
    const IrradianceCache cache(ray_scene, records_of(wave, noise), 2);
    const Errors errors = errors_of(cache, wave);
    EXPECT_GT(errors.told, 0.6 * errors.true_error) << noise;
    EXPECT_LT(errors.told, 1.7 * errors.true_error) << noise;
    // Fits take most of the noise.
    EXPECT_LT(errors.true_error, std::max(2 * noise, 0.05)) << noise;
  }
}

// What a single record is off by, and says so, is told around it and nowhere else.
TEST(IrradianceCache, TellsTheNoiseOfEachRecord) {
  const Scene scene = floor_scene(false);
  const RayScene ray_scene(scene, 1);
  const auto wave = [](double x, double y) { return 2 + std::cos(3 * x) * std::sin(3 * y); };
  std::vector<IrradianceRecord> records = records_of(wave);
  const IrradianceCache even(ray_scene, records, 2);
  IrradianceRecord& noisy = records[records.size() / 2 + 20];
  constexpr double kOff = 50;
  noisy.irradiance += kOff * Rgb(1, 2, 3);
  noisy.variance = 4 * kOff * kOff;
  const IrradianceCache cache(ray_scene, records, 2);
  const Errors errors = errors_of(cache, wave);
  EXPECT_GT(errors.true_error, 10 * errors_of(even, wave).true_error);
  EXPECT_NEAR(errors.told, errors.true_error, 0.2 * errors.true_error);
  int far = 0;
  for (double x = -1.8; x < 1.8; x += 0.1) {
    const SidePoint place = on_floor(x, 0.3);
    if (glm::distance(place.position, noisy.at.position) < 3 * even.at(place).reach) continue;
    EXPECT_EQ(cache.at(place).noise, 0) << x;
    EXPECT_EQ(cache.at(place).bias(), even.at(place).bias()) << x;
    ++far;
  }
  EXPECT_GT(far, 10);
}

TEST(IrradianceCache, NothingPassesAWall) {
  const auto bright_beyond = [](double x, double) { return x > 0 ? 1.0 : 0.0; };
  for (const bool with_wall : {false, true}) {
    const Scene scene = floor_scene(with_wall);
    const RayScene ray_scene(scene, 1);
    const IrradianceCache cache(ray_scene, records_of(bright_beyond), 1);
    const Rgb dark = cache.at(on_floor(-0.02, 0.3)).irradiance;
    if (with_wall)
      EXPECT_EQ(dark, Rgb(0));
    else
      EXPECT_GT(dark.r, 0.1);
  }
}

// Records of faces beside each other count for a curved surface, on its inside and on its outside.
TEST(IrradianceCache, GoesAroundWhatIsCurved) {
  constexpr int kFaces = 48;
  Scene scene = by_hand::empty_scene(Sides::two);
  const auto at = [](double k, double z) {
    const double angle = 2 * std::numbers::pi * k / kFaces;
    return glm::dvec3(std::cos(angle), std::sin(angle), z);
  };
  for (int k = 0; k < kFaces; ++k)
    by_hand::add(scene, "tube", {at(k, 0), at(k + 1, 0), at(k + 1, 1), at(k, 1)});
  scene = test_scenes::finished(std::move(scene));
  const RayScene ray_scene(scene, 1);
  for (const double side : {1.0, -1.0}) {
    const auto place = [&](std::uint32_t face, double z) {
      const glm::dvec3 middle = 0.5 * (at(face, z) + at(face + 1, z));
      return SidePoint{middle, side * glm::normalize(glm::dvec3(middle.x, middle.y, 0)), face};
    };
    std::vector<IrradianceRecord> records;
    for (std::uint32_t face = 0; face < kFaces; face += 2)
      for (double z = 0.05; z < 1; z += 0.25)
        records.push_back({place(face, z), Rgb(3 + place(face, z).position.x)});
    const IrradianceCache cache(ray_scene, records, 1);
    for (std::uint32_t face = 1; face < kFaces; face += 2) {
      const SidePoint between = place(face, 0.5);
      const Interpolated found = cache.at(between);
      EXPECT_GE(found.records, 3) << face;
      EXPECT_NEAR(found.irradiance.r, 3 + between.position.x, 0.03) << face;
    }
  }
}

}  // namespace
}  // namespace fluxel
