#include "reference/sensors.hpp"
#include "reference/receiver_sensors.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <numbers>

#include "tests/closed_forms/points.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

/// Mean of many paths, red channel.
double mean(const Sensors& sensors, std::size_t sensor) {
  constexpr std::uint32_t kSamples = 16384;
  std::vector<SensorPath> paths;
  for (std::uint32_t index = 0; index < kSamples; ++index)
    paths.push_back({sensor, OwenSobol(sensor + 1, index)});
  std::vector<Rgb> found(kSamples);
  std::uint64_t rays = 0;
  sensors.measure(paths, found, rays);
  double sum = 0;
  for (const Rgb& value : found) sum += value.r;
  return sum / kSamples;
}

/// A lamp over [0, 1]^2 at z = 1 that shines down, and a square of reflectance 1/2 below it, both two-sided.
struct LampAndFloor {
  Scene scene = made();
  RayScene rays{scene, 1};
  LightPaths paths{rays};
  std::vector<ElementShape> elements{{scene.patches[0].outline, PatchId{0}},
                                     {scene.patches[1].outline, PatchId{1}}};

 private:
  static Scene made() {
    Scene made = by_hand::empty_scene(Sides::two);
    by_hand::add(made, "lamp", {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}, by_hand::kLight);
    by_hand::add(made, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    return test_scenes::finished(std::move(made));
  }
};

TEST(Sensors, ElementsHaveFrontsThenBacks) {
  const LampAndFloor of;
  const auto sensors = element_sensors(of.paths, of.scene, of.elements);
  ASSERT_EQ(sensors->size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_DOUBLE_EQ(sensors->weight(k), 1);
  EXPECT_EQ(mean(*sensors, 0), 1) << "a black lamp's own light";
  EXPECT_NEAR(mean(*sensors, 1), 0.5 * closed_forms::opposed_rectangles(1, 1, 1), 1e-3);
  EXPECT_EQ(mean(*sensors, 2), 0) << "a lamp's back is dark";
  EXPECT_EQ(mean(*sensors, 3), 0) << "nothing is below the floor";
}

TEST(Sensors, PlacesHaveTheRadiosityOfAPoint) {
  const LampAndFloor of;
  const std::vector<SurfacePlace> places{{{{0.5, 0.5, 0}, {0, 0, 1}}, PatchId{1}, true, Rgb(0), Rgb(0.5)},
                                         {{{0.5, 0.5, 0}, {0, 0, 1}}, PatchId{1}, true, Rgb(2), Rgb(1)}};
  const auto sensors = place_sensors(of.paths, places);
  ASSERT_EQ(sensors->size(), 2u);
  const double H = closed_forms::point_to_parallel_rectangle({-0.5, 0.5, -0.5, 0.5}, 1);
  EXPECT_NEAR(mean(*sensors, 0), 0.5 * H, 1e-3);
  EXPECT_NEAR(mean(*sensors, 1), 2 + H, 2e-3);
}

TEST(Sensors, SidesThatAreNotActiveWeighNothing) {
  LampAndFloor of;
  of.scene.patches[1].sides = kFront;
  const auto sensors = element_sensors(of.paths, of.scene, of.elements);
  ASSERT_EQ(sensors->size(), 4u);
  EXPECT_EQ(sensors->weight(2), 1);
  EXPECT_EQ(sensors->weight(3), 0);
  of.scene.patches[0].sides = kFront;
  EXPECT_EQ(element_sensors(of.paths, of.scene, of.elements)->size(), 2u);
}

/// Looks at half of the lamp from below: the upper half of the picture sees it.
TEST(Sensors, PixelsHaveTheirTopRowFirst) {
  const LampAndFloor of;
  const Camera camera{{0.5, 0, 0.5}, {0.5, 0, 1}, {0, 1, 0}, 90, 2, 2};
  for (const int supersample : {0, 1, 3}) {
    const auto sensors = pixel_sensors(of.paths, of.scene, camera, supersample);
    ASSERT_EQ(sensors->size(), 4u);
    for (const std::size_t pixel : {0u, 1u})
      EXPECT_NEAR(mean(*sensors, pixel), std::numbers::inv_pi, 1e-12) << supersample;
    for (const std::size_t pixel : {2u, 3u}) EXPECT_EQ(mean(*sensors, pixel), 0) << supersample;
  }
}

TEST(Sensors, PixelsOfAFurnaceShine) {
  Scene scene = test_scenes::unit_cube();
  scene.materials[0].rho = Rgb(0.6);
  scene.materials[0].E = Rgb(0.4);
  const RayScene rays(scene, 1);
  const LightPaths paths(rays);
  const Camera camera{{0.1, 0, -0.1}, {0.4, 0.3, 0.2}, {0, 0, 1}, 70, 1, 1};
  EXPECT_NEAR(std::numbers::pi * mean(*pixel_sensors(paths, scene, camera, 0), 0), 1, 1e-2);
}

/// Half a pixel is lit: all of its area says so, its centre does not, nor do the centres of its parts.
TEST(Sensors, PixelsAreAreasOrPoints) {
  const LampAndFloor of;
  const Camera camera{{0.5, -0.1, 0.5}, {0.5, -0.1, 1}, {0, 1, 0}, 90, 1, 1};
  const auto lit = [&](int supersample) {
    return std::numbers::pi * mean(*pixel_sensors(of.paths, of.scene, camera, supersample), 0);
  };
  EXPECT_NEAR(lit(0), 0.4, 2e-3);
  EXPECT_EQ(lit(1), 0);
  EXPECT_NEAR(lit(2), 0.5, 1e-9);
  EXPECT_NEAR(lit(4), 0.5, 1e-9);
  EXPECT_NEAR(lit(5), 0.4, 2e-3);
}

Receiver grid(const glm::dvec3& origin, const glm::dvec3& u, const glm::dvec3& v, int cells) {
  Receiver receiver;
  receiver.origin = origin;
  receiver.u = u;
  receiver.v = v;
  receiver.columns = receiver.rows = cells;
  return receiver;
}

TEST(Sensors, CellsAreThePixelsOfAPictureOfTheReceiver) {
  const LampAndFloor of;
  const Receiver receiver = grid({-1, -1, 0.5}, {3, 0, 0}, {0, 3, 0}, 3);
  const auto sensors = receiver_sensors(of.paths, receiver);
  ASSERT_EQ(sensors->size(), 9u);
  const auto irradiance = [](double x, double y) {
    return closed_forms::parallel_rectangles({x, x + 1, y, y + 1}, {0, 1, 0, 1}, 0.5);
  };
  for (const int row : {0, 1, 2})
    for (const int column : {0, 1, 2})
      EXPECT_NEAR(mean(*sensors, static_cast<std::size_t>(3 * row + column)), irradiance(column - 1, 1 - row),
                  4e-3);
  // One cell less symmetric: only the last along u and v is under the lamp.
  const Receiver corner = grid({-1, -1, 0.9}, {2, 0, 0}, {0, 2, 0}, 2);
  const auto of_corner = receiver_sensors(of.paths, corner);
  for (std::size_t cell = 0; cell < 4; ++cell) EXPECT_EQ(mean(*of_corner, cell) > 0.5, cell == 1);
  const Receiver turned = grid({-1, -1, 0.9}, {0, 2, 0}, {2, 0, 0}, 2);
  EXPECT_LT(mean(*receiver_sensors(of.paths, turned), 1), 0.2) << "u x v points down, to the floor";
}

}  // namespace
}  // namespace fluxel
