#include "scene/sealed_sides.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "scene/cut_patches.hpp"
#include "scene_by_hand.hpp"

namespace fluxel {
namespace {

using namespace by_hand;

constexpr std::uint32_t kBoth = kFront | kBack;

/// A lit room (an open floor and a lamp) with a box in it.
struct RoomWithBox {
  explicit RoomWithBox(bool outward, Sides sides = Sides::two) : scene(empty_scene(sides)) {
    scene.origin = {100, 0, 0};
    floor = add(scene, "floor", {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}});
    lamp = add(scene, "lamp", {{-1, -1, 4}, {-1, 1, 4}, {1, 1, 4}, {1, -1, 4}}, kLight);
    box = add_box(scene, "box", {2, 2, 1}, {3, 3, 2}, outward);
  }
  void seal(std::optional<glm::dvec3> eye = {}) {
    cut_patches(scene, connect_patches(scene), true);
    leave_out_sealed_sides(scene, connect_patches(scene), eye);
  }
  [[nodiscard]] std::uint32_t box_sides() const { return scene.patch(box).sides; }

  Scene scene;
  PatchId floor{}, lamp{}, box{};
};

TEST(SealedSides, WindingNumberTellsInsideFromOutside) {
  for (const bool outward : {true, false}) {
    RoomWithBox room(outward);
    const PatchMesh mesh = connect_patches(room.scene);
    ASSERT_EQ(mesh.components.size(), 3u);
    EXPECT_NEAR(winding_number(room.scene, mesh.components[2], {2.9, 2.1, 1.01}), outward ? 1 : -1, 1e-12);
    EXPECT_NEAR(winding_number(room.scene, mesh.components[2], {3.01, 2.1, 1.5}), 0, 1e-12);
  }
}

TEST(SealedSides, BacksOfABoxAreLeftOut) {
  RoomWithBox room(true);
  room.seal();
  EXPECT_EQ(room.scene.statistics.sealed_sides, 6u);
  for (std::uint32_t i = 0; i < 6; ++i) EXPECT_EQ(room.scene.patches[index(room.box) + i].sides, kFront);
  EXPECT_EQ(room.scene.patch(room.floor).sides, kBoth);
  EXPECT_EQ(room.scene.notes.size(), 1u);
}

TEST(SealedSides, FrontsOfABoxTurnedInwardAreLeftOut) {
  RoomWithBox room(false);
  room.seal();
  EXPECT_EQ(room.scene.statistics.sealed_sides, 6u);
  EXPECT_EQ(room.box_sides(), kBack);
}

TEST(SealedSides, LightComesThroughAClearBodysSurface) {
  RoomWithBox room(true);
  room.scene.materials.push_back({.name = "glass", .rho = Rgb(0), .sides = Sides::two});
  room.scene.materials.back().optics.refraction_index = 1.5;
  for (std::uint32_t i = 0; i < 6; ++i) room.scene.patches[index(room.box) + i].material = MaterialId{2};
  room.seal();
  EXPECT_EQ(room.scene.statistics.sealed_sides, 0u);
  EXPECT_EQ(room.box_sides(), kBoth);
}

TEST(SealedSides, LightComesThroughOneFaceThatTransmits) {
  const SurfaceOptics straight{.transmission = Rgb(0, 0.1, 0)}, evenly{.diffuse_transmission = Rgb(0.1)},
      mirror{.mirror = Rgb(1)};
  for (const SurfaceOptics& optics : {straight, evenly, mirror}) {
    RoomWithBox room(true);
    room.scene.materials.push_back({.name = "pane", .rho = Rgb(0), .sides = Sides::two, .optics = optics});
    room.scene.patches[index(room.box) + 3].material = MaterialId{2};
    room.seal();
    EXPECT_EQ(room.box_sides(), optics == mirror ? kFront : kBoth);
    EXPECT_EQ(room.scene.statistics.sealed_sides, optics == mirror ? 6u : 0u);
  }
}

TEST(SealedSides, AnEmitterInsideKeepsThem) {
  RoomWithBox room(true);
  add(room.scene, "candle", {{2.4, 2.4, 1.5}, {2.6, 2.4, 1.5}, {2.6, 2.6, 1.5}}, kLight);
  room.seal();
  EXPECT_EQ(room.scene.statistics.sealed_sides, 0u);
  EXPECT_EQ(room.box_sides(), kBoth);
}

TEST(SealedSides, AnEmitterThatReachesInKeepsThem) {
  RoomWithBox room(true);
  // One triangle through the box's wall with its centroid outside: its part inside is a piece of its own.
  add(room.scene, "candle", {{2.5, 2.5, 1.5}, {4.5, 2.4, 1.5}, {4.5, 2.6, 1.5}}, kLight);
  room.seal();
  EXPECT_EQ(room.box_sides(), kBoth);
}

TEST(SealedSides, TheCameraInsideKeepsThem) {
  RoomWithBox room(true);
  room.seal(glm::dvec3{102.5, 2.5, 1.5});  // world
  EXPECT_EQ(room.box_sides(), kBoth);
  RoomWithBox other(true);
  other.seal(glm::dvec3{2.5, 2.5, 1.5});
  EXPECT_EQ(other.box_sides(), kFront);
}

TEST(SealedSides, ALuminaireInsideKeepsThem) {
  for (const glm::dvec3 position : {glm::dvec3(2.5, 2.5, 1.5), glm::dvec3(2.5, 2.5, 2)}) {  // or in its top
    RoomWithBox room(true);
    room.scene.luminaires.emplace_back().position = position;
    room.seal();
    EXPECT_EQ(room.box_sides(), kBoth);
  }
  RoomWithBox room(true);
  room.scene.luminaires.emplace_back().position = {2.5, 2.5, 1};  // below it
  room.seal();
  EXPECT_EQ(room.box_sides(), kFront);
  RoomWithBox shone_into(true);
  shone_into.scene.luminaires.emplace_back().position = {2.5, 2.5, 1};
  shone_into.scene.intensities.push_back({{0}, {0, std::numbers::pi}, {1, 1}});
  shone_into.seal();
  EXPECT_EQ(shone_into.box_sides(), kBoth) << "it shines up as well";
}

TEST(SealedSides, AnEmitterOnTheOutsideDoesNot) {
  RoomWithBox room(true);
  // In the plane of the box's top, facing up: the light starts outside.
  add(room.scene, "panel", {{2.2, 2.2, 2}, {2.8, 2.2, 2}, {2.8, 2.8, 2}, {2.2, 2.8, 2}}, kLight);
  room.seal();
  EXPECT_EQ(room.box_sides(), kFront);
}

TEST(SealedSides, AnEmittingFaceCountsWhereItsFrontLooks) {
  for (const bool outward : {true, false}) {
    RoomWithBox room(outward);
    room.scene.patches[index(room.box) + 2].material = kLight;
    room.seal();
    EXPECT_EQ(room.box_sides(), outward ? kFront : kBoth);
  }
}

TEST(SealedSides, TheLitRoomItselfIsNotSealed) {
  for (const bool outward : {true, false}) {
    RoomWithBox room(true);
    const PatchId shell = add_box(room.scene, "shell", {-6, -6, -1}, {6, 6, 6}, outward);
    room.seal();
    EXPECT_EQ(room.scene.patch(shell).sides, kBoth);
    EXPECT_EQ(room.box_sides(), kFront);
  }
}

TEST(SealedSides, AnOpenBoxIsNotSealed) {
  RoomWithBox room(true);
  room.scene.patches.pop_back();
  room.seal();
  EXPECT_EQ(room.scene.statistics.sealed_sides, 0u);
}

TEST(SealedSides, AFlippedFaceLeavesAllSides) {
  RoomWithBox room(true);
  Patch& top = room.scene.patches[index(room.box) + 1];
  std::reverse(top.outline.corner.begin(), top.outline.corner.end());
  top.normal = -top.normal;
  room.seal();
  EXPECT_EQ(room.scene.statistics.sealed_sides, 0u);
}

TEST(SealedSides, OneSidedScenesKeepTheirFronts) {
  RoomWithBox room(false, Sides::one);
  room.seal();
  EXPECT_EQ(room.scene.statistics.sealed_sides, 0u);
  EXPECT_EQ(room.box_sides(), kFront);
}

}  // namespace
}  // namespace fluxel
