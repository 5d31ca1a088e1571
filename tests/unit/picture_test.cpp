#include "image/picture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace fluxel {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Element 0 is two-sided, element 1 one-sided.
struct Small {
  Scene scene;
  ElementMesh mesh;
  SurfaceLight light;

  Small() {
    Material two, one;
    two.rho = Rgb(0.1, 0.2, 0.3);
    one.rho = Rgb(0.5);
    scene.materials = {two, one};
    Element first, second;
    first.normal = glm::vec3(0, 0, 1);
    first.sides = kFront | kBack;
    first.material = MaterialId{0};
    second.normal = glm::vec3(0, 1, 0);
    second.sides = kFront;
    second.material = MaterialId{1};
    mesh.elements = {first, second};
    light.B_front = {Rgb(1, 2, 3), Rgb(8)};
    light.B_back = {Rgb(4, 5, 6), Rgb(100)};
    light.H_front = {Rgb(10), Rgb(16)};
    light.H_back = {Rgb(20), Rgb(100)};
  }
};

/// A raster of these elements; everything seen from the front at depth 2.
Raster raster_of(int width, int height, std::vector<ElementId> elements) {
  Raster raster;
  raster.width = width;
  raster.height = height;
  for (const ElementId id : elements) raster.depth.push_back(id == kNoElement ? kInfinity : 2.0);
  raster.patch.assign(elements.size(), kNoPatch);
  raster.front.assign(elements.size(), 1);
  raster.element = std::move(elements);
  return raster;
}

void expect_rgb(const Rgb& value, const Rgb& expected) {
  for (int c = 0; c < kChannels; ++c) EXPECT_NEAR(value[c], expected[c], 1e-12 * std::abs(expected[c]));
}

TEST(Picture, ShowsTheSideThatIsSeen) {
  const Small small;
  Raster raster = raster_of(4, 1, {ElementId{0}, ElementId{0}, ElementId{1}, ElementId{1}});
  raster.front = {1, 0, 1, 0};
  const Picture picture = make_picture(raster, 1, small.scene, small.mesh, small.light);
  expect_rgb(picture.radiance[0], Rgb(1, 2, 3) / std::numbers::pi);
  expect_rgb(picture.radiance[1], Rgb(4, 5, 6) / std::numbers::pi);
  expect_rgb(picture.radiance[2], Rgb(8) / std::numbers::pi);
  expect_rgb(picture.irradiance[0], Rgb(10));
  expect_rgb(picture.irradiance[1], Rgb(20));
  expect_rgb(picture.reflectance[1], Rgb(0.1, 0.2, 0.3));
  EXPECT_EQ(picture.normal[0], glm::vec3(0, 0, 1));
  EXPECT_EQ(picture.normal[1], glm::vec3(0, 0, -1));
  // The back of the one-sided element is seen, but black.
  EXPECT_EQ(picture.radiance[3], Rgb(0.0));
  EXPECT_EQ(picture.reflectance[3], Rgb(0.0));
  EXPECT_EQ(picture.irradiance[3], Rgb(0.0));
  EXPECT_EQ(picture.element[3], ElementId{1});
  EXPECT_EQ(picture.normal[3], glm::vec3(0, -1, 0));
}

TEST(Picture, OneSidedSceneNeedsNoBackVectors) {
  Small small;
  small.light.B_back.clear();
  small.light.H_back.clear();
  small.mesh.elements[0].sides = kFront;
  Raster raster = raster_of(1, 1, {ElementId{0}});
  raster.front = {0};
  const Picture picture = make_picture(raster, 1, small.scene, small.mesh, small.light);
  EXPECT_EQ(picture.radiance[0], Rgb(0.0));
}

TEST(Picture, BackgroundIsBlackAndInfinitelyFar) {
  const Small small;
  const Picture picture =
      make_picture(raster_of(1, 1, {kNoElement}), 1, small.scene, small.mesh, small.light);
  EXPECT_EQ(picture.radiance[0], Rgb(0.0));
  EXPECT_EQ(static_cast<std::uint32_t>(picture.element[0]), 0xFFFFFFFFu);
  EXPECT_TRUE(std::isinf(picture.depth[0]));
  EXPECT_EQ(picture.normal[0], glm::vec3(0));
}

TEST(Picture, MeansOverSubPixelsAndCentreOfOddSupersample) {
  const Small small;
  std::vector<ElementId> elements(18, ElementId{0});
  // Rows of six sub-pixels, two pixels side by side; the right one sees element 1 in one sub-pixel, its
  // centre, and the background in another.
  elements[6 + 4] = ElementId{1};
  elements[5] = kNoElement;
  const Picture picture = make_picture(raster_of(6, 3, elements), 3, small.scene, small.mesh, small.light);
  ASSERT_EQ(picture.width, 2);
  ASSERT_EQ(picture.height, 1);
  expect_rgb(picture.radiance[0], Rgb(1, 2, 3) / std::numbers::pi);
  expect_rgb(picture.radiance[1], (7.0 * Rgb(1, 2, 3) + Rgb(8)) / 9.0 / std::numbers::pi);
  expect_rgb(picture.irradiance[1], Rgb((7 * 10.0 + 16) / 9));
  expect_rgb(picture.reflectance[1], (7.0 * Rgb(0.1, 0.2, 0.3) + Rgb(0.5)) / 9.0);
  EXPECT_EQ(picture.element[0], ElementId{0});
  EXPECT_EQ(picture.element[1], ElementId{1});
  EXPECT_EQ(picture.normal[1], glm::vec3(0, 1, 0));
}

TEST(Picture, EvenSupersampleTakesTheLowerRightOfTheFourAtTheCentre) {
  const Small small;
  Raster raster = raster_of(2, 4, std::vector<ElementId>(8, ElementId{0}));
  raster.element[7] = ElementId{1};
  raster.depth[7] = 5;
  const Picture picture = make_picture(raster, 2, small.scene, small.mesh, small.light);
  ASSERT_EQ(picture.height, 2);
  EXPECT_EQ(picture.element[0], ElementId{0});
  EXPECT_EQ(picture.element[1], ElementId{1});
  EXPECT_EQ(picture.depth[0], 2.0f);
  EXPECT_EQ(picture.depth[1], 5.0f);
}

TEST(Picture, RefusesSizesThatDoNotFit) {
  Small small;
  const Raster raster = raster_of(3, 2, std::vector<ElementId>(6, ElementId{0}));
  EXPECT_THROW((void)make_picture(raster, 2, small.scene, small.mesh, small.light), std::logic_error);
  small.light.B_back.pop_back();
  EXPECT_THROW((void)make_picture(raster, 1, small.scene, small.mesh, small.light), std::logic_error);
}

}  // namespace
}  // namespace fluxel
