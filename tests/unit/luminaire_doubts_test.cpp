#include "optics/luminaire_doubts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

#include "tests/unit/test_scenes.hpp"

namespace fluxel::luminaire_doubts_test {
namespace {

/// Whether a sentence has all the words.
bool says(const std::string& sentence, const std::vector<std::string>& words) {
  return std::ranges::all_of(
      words, [&](const std::string& word) { return sentence.find(word) != std::string::npos; });
}

/// The inside of a room of 4 x 4 x 3 m on z = 0, with a closed body on its floor; lamps of 100 cd in all
/// directions.
struct Room {
  Scene scene = by_hand::empty_scene(Sides::one);

  Room() {
    by_hand::add_box(scene, "room", {-2, -2, 0}, {2, 2, 3}, false);
    by_hand::add_box(scene, "cupboard", {1, 1, 0.01}, {1.9, 1.9, 2}, true);
    scene.intensities.push_back({{0}, {0, std::numbers::pi}, {100, 100}});
    scene.intensities.push_back({{0}, {0, std::numbers::pi}, {0, 0}});
  }

  Luminaire& add(const char* name, const glm::dvec3& position, const glm::dvec2& size = glm::dvec2(0)) {
    Luminaire& lamp = scene.luminaires.emplace_back();
    lamp.name = name;
    lamp.position = position;
    lamp.size = size;
    return lamp;
  }

  /// `closed`: as whoever builds a scene finds.
  [[nodiscard]] LuminaireDoubts doubts(bool closed = false) const {
    Scene made = test_scenes::finished(scene);
    made.statistics.closed = closed;
    return luminaire_doubts(RayScene(made, 1));
  }
};

TEST(LuminaireDoubts, NoneOfLuminairesThatHangFreely) {
  Room room;
  room.add("point", {0, 0, 2});
  room.add("opening", {0, 0, 2.5}, {0.05, 0.05});
  const LuminaireDoubts found = room.doubts();
  EXPECT_TRUE(found.warnings.empty());
  EXPECT_FALSE(found.note.has_value());
}

TEST(LuminaireDoubts, AnOpeningInThePlaneOfTheCeilingIsNotCut) {
  Room room;
  room.add("flush", {0, 0, 3}, {0.6, 0.6});
  EXPECT_TRUE(room.doubts().warnings.empty());
}

TEST(LuminaireDoubts, AnOpeningThroughAWallIsCut) {
  Room room;
  room.add("square", {-1.8, 0, 2}, {0.6, 0.1});
  const LuminaireDoubts found = room.doubts();
  ASSERT_EQ(found.warnings.size(), 2u) << "what starts outside meets the backs of the walls";
  EXPECT_PRED2(says, found.warnings[0], (std::vector<std::string>{"'square'", "cut by 'room'"}));
  EXPECT_PRED2(says, found.warnings[1], (std::vector<std::string>{"'square'", "dark backs"}));
}

TEST(LuminaireDoubts, ADiscEndsBeforeItsSquare) {
  Room room;
  Luminaire& lamp = room.add("disc", {0.8, 0.8, 1}, {0.5, 0.5});
  lamp.round = true;
  EXPECT_TRUE(room.doubts().warnings.empty()) << "the square's corner would be in the cupboard";
  lamp.round = false;
  const LuminaireDoubts found = room.doubts();
  ASSERT_FALSE(found.warnings.empty());
  EXPECT_PRED2(says, found.warnings[0], (std::vector<std::string>{"cut by 'cupboard'"}));
}

TEST(LuminaireDoubts, ALuminaireInsideABodySendsItsLightToBacks) {
  Room room;
  room.add("lost", {1.5, 1.5, 1});
  const LuminaireDoubts found = room.doubts();
  ASSERT_EQ(found.warnings.size(), 1u);
  EXPECT_PRED2(says, found.warnings[0],
               (std::vector<std::string>{"'lost' sends 100 % of its light", "'cupboard'"}));
}

TEST(LuminaireDoubts, NearSurfacesAreToldOfOpeningsAlone) {
  Room room;
  Luminaire& lamp = room.add("opening", {0, 0, 2.5}, {0.3, 0.2});
  const LuminaireDoubts found = room.doubts();
  EXPECT_TRUE(found.warnings.empty());
  ASSERT_TRUE(found.note.has_value());
  EXPECT_PRED2(says, *found.note, (std::vector<std::string>{"'opening'", "'room' from 0.5", "five times"}));
  lamp.size = glm::dvec2(0);
  EXPECT_FALSE(room.doubts().note.has_value());
}

TEST(LuminaireDoubts, ALuminaireOutsideAClosedRoomLosesItsLight) {
  Room room;
  room.add("outside", {0, 0, 30});
  EXPECT_TRUE(room.doubts().warnings.empty());
  const LuminaireDoubts found = room.doubts(true);
  ASSERT_EQ(found.warnings.size(), 1u) << "less than 1 % meets the roof";
  EXPECT_PRED2(says, found.warnings[0], (std::vector<std::string>{"'outside' sends", "out of the scene"}));
}

TEST(LuminaireDoubts, ASpotTooSmallToBeFound) {
  Room room;
  Luminaire& lamp = room.add("spot", {0, 0, 2.999});
  const LuminaireDoubts found = room.doubts();
  ASSERT_EQ(found.warnings.size(), 1u);
  EXPECT_PRED2(says, found.warnings[0],
               (std::vector<std::string>{"'spot' lights 'room' from 0.00", "spot so small"}));
  lamp.position.z = 2.9;
  EXPECT_TRUE(room.doubts().warnings.empty());
}

TEST(LuminaireDoubts, TheWorstStandsForAll) {
  Room room;
  room.add("a little", {-1.9, 0, 2}, {0.3, 0.01});
  room.add("most", {-1.9, 0, 2}, {0.6, 0.01});
  room.add("off", {1.5, 1.5, 1}, {3, 3}).intensity = 1;
  const LuminaireDoubts found = room.doubts();
  ASSERT_EQ(found.warnings.size(), 2u);
  for (const std::string& warning : found.warnings)
    EXPECT_PRED2(says, warning, (std::vector<std::string>{"'most' (the worst of 2)"}));
}

}  // namespace
}  // namespace fluxel::luminaire_doubts_test
