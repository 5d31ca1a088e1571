#include "scene/readers/placing.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace fluxel::placing_test {
namespace {

constexpr double kPi = std::numbers::pi;

/// A lamp that hangs at (1, 2, 3) and shines down, C = 0 along x and C = 90 degrees along y, a camera below,
/// and a table of more light towards C = 90 degrees.
SceneInput lamp_and_camera() {
  SceneInput part;
  Luminaire lamp;
  lamp.position = {1, 2, 3};
  lamp.size = {0.5, 0.25};
  part.luminaires.push_back(lamp);
  part.intensities.push_back(
      {{0, kPi / 2, kPi, 1.5 * kPi, 2 * kPi}, {0, 1}, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}});
  InputCamera camera;
  camera.eye = {{1, 0, 0}, 4};
  camera.look_at = {{1, 2, 3}, 5};
  camera.up = {{0, 1, 0}, 6};
  part.cameras.push_back(camera);
  return part;
}

TEST(Placing, UnitsScaleWhatHasALength) {
  SceneInput part = lamp_and_camera();
  place(part, {.file = {}, .metres_per_unit = 0.1, .translate = {10, 0, 0}});
  const Luminaire& lamp = part.luminaires[0];
  EXPECT_LT(glm::distance(lamp.position, {10.1, 0.2, 0.3}), 1e-15);
  EXPECT_LT(glm::distance(lamp.size, {0.05, 0.025}), 1e-15);
  EXPECT_EQ(lamp.aim, glm::dvec3(0, 0, -1));
  EXPECT_EQ(lamp.ahead, glm::dvec3(1, 0, 0));
  EXPECT_EQ(part.intensities[0].intensity[3], 4);
  const InputCamera& camera = part.cameras[0];
  EXPECT_LT(glm::distance(camera.eye->value, {10.1, 0, 0}), 1e-15);
  EXPECT_EQ(camera.eye->line, 4u);
  EXPECT_LT(glm::distance(camera.look_at->value, {10.1, 0.2, 0.3}), 1e-15);
  EXPECT_EQ(camera.up->value, glm::dvec3(0, 1, 0));
}

TEST(Placing, EachSideOfALampIsScaledAlongItself) {
  SceneInput part = lamp_and_camera();
  InputGeometry geometry;
  geometry.linear[0][0] = 2;
  geometry.linear[1][1] = 4;
  place(part, geometry);
  EXPECT_EQ(part.luminaires[0].size, glm::dvec2(1, 1));
}

/// The intensity that the lamp's table has towards a direction of the scene, of those that stand in it.
double towards(const SceneInput& part, const glm::dvec3& direction) {
  const Luminaire& lamp = part.luminaires[0];
  const glm::dvec3 across = glm::cross(lamp.ahead, lamp.aim);
  double C = std::atan2(glm::dot(direction, across), glm::dot(direction, lamp.ahead));
  if (C < 0) C += 2 * kPi;
  const IntensityTable& table = part.intensities[0];
  for (std::size_t c = 0; c < table.C.size(); ++c)
    if (std::abs(table.C[c] - C) < 1e-12) return table.at(c, 1);
  ADD_FAILURE() << "no such C";
  return 0;
}

TEST(Placing, MirroredLampsShineWhereTheirImagesDo) {
  for (int axis = 0; axis < 3; ++axis) {
    SceneInput part = lamp_and_camera();
    const SceneInput plain = part;
    InputGeometry geometry;
    geometry.linear[axis][axis] = -1;
    place(part, geometry);
    EXPECT_EQ(part.intensities[0].C, plain.intensities[0].C);
    for (const glm::dvec3 direction : {glm::dvec3(0, 1, 0), glm::dvec3(0, -1, 0), glm::dvec3(-1, 0, 0)})
      EXPECT_EQ(towards(part, geometry.linear * direction), towards(plain, direction)) << axis;
    EXPECT_EQ(towards(plain, {0, 1, 0}), 4) << "C = 90 degrees";
  }
}

}  // namespace
}  // namespace fluxel::placing_test
