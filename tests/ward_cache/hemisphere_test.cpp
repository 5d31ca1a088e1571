#include "tests/ward_cache/hemisphere.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

namespace fluxel::ward_cache {
namespace {

constexpr double kHeight = 1.5;

/// A ceiling over the plane z = 0, with light that falls off around (0.4, 0.3).
Sight ceiling(const glm::dvec3& from, const glm::dvec3& direction) {
  if (direction.z <= 0) return {std::numeric_limits<double>::infinity(), Rgb(0)};
  const double t = (kHeight - from.z) / direction.z;
  const glm::dvec3 d = from + t * direction - glm::dvec3(0.4, 0.3, 0);
  return {t, Rgb(1, 2, 3) * std::exp(-(d.x * d.x + 2 * d.y * d.y))};
}

HemisphereLight light_at(const glm::dvec3& from, const glm::dvec3& normal) {
  return look_around(normal, {128, 402},
                     [&](const glm::dvec3& direction) { return ceiling(from, direction); });
}

// Against differences of the irradiance of places and normals a little apart.
TEST(Hemisphere, GradientsAreThoseOfTheIrradiance) {
  constexpr double kStep = 0.02;
  for (const glm::dvec3& normal : {glm::dvec3(0, 0, 1), glm::normalize(glm::dvec3(0.2, -0.3, 1))}) {
    const HemisphereLight here = light_at({0, 0, 0}, normal);
    for (const glm::dvec3& along : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)}) {
      const glm::dvec3 in_plane = glm::normalize(along - glm::dot(along, normal) * normal);
      const double moved = (light_at(kStep * in_plane, normal).irradiance.g -
                            light_at(-kStep * in_plane, normal).irradiance.g) /
                           (2 * kStep);
      EXPECT_NEAR(glm::dot(here.translation[1], in_plane), moved, 0.02 * here.irradiance.g);
      const glm::dvec3 to = glm::normalize(normal + kStep * in_plane),
                       fro = glm::normalize(normal - kStep * in_plane);
      const double turned =
          (light_at({0, 0, 0}, to).irradiance.g - light_at({0, 0, 0}, fro).irradiance.g) / (2 * kStep);
      EXPECT_NEAR(glm::dot(here.rotation[1], glm::cross(normal, in_plane)), turned, 0.02 * here.irradiance.g);
    }
    EXPECT_NEAR(here.rotation[2].x, 3 * here.rotation[0].x, 1e-12);
  }
}

// Below a plane the mean of cos(theta) / h over the projected solid angle is 2 / (3 h).
TEST(Hemisphere, MeanDistanceIsHarmonic) {
  const HemisphereLight here = light_at({0, 0, 0}, {0, 0, 1});
  EXPECT_NEAR(here.mean_distance, 1.5 * kHeight, 1e-3);
}

TEST(Hemisphere, OfNothingThereIsNothing) {
  const HemisphereLight here = light_at({0, 0, 0}, {0, 0, -1});
  EXPECT_EQ(here.irradiance, Rgb(0));
  EXPECT_TRUE(std::isinf(here.mean_distance));
}

}  // namespace
}  // namespace fluxel::ward_cache
