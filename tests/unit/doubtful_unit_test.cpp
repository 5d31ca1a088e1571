#include "scene/readers/doubtful_unit.hpp"

#include <gtest/gtest.h>

#include "tests/unit/messages.hpp"

namespace fluxel::doubtful_unit_test {
namespace {

using test_messages::expect_words;

/// A triangle as wide as that, off the origin, of a file without a unit.
SceneInput scene_of(double width, const std::string& file = "room.obj") {
  SceneInput input;
  input.file = file;
  input.polygons.push_back({{{1e4, 5, 5}, {1e4 + width / 2, 5, 5}, {1e4, 5, 5 + width}}, {}, {}});
  input.geometry.push_back({.file = file});
  return input;
}

std::string doubt(const SceneInput& input) { return doubt_of_unit(input).value_or("none"); }

TEST(DoubtfulUnit, AsksOfScenesThatAreNoRooms) {
  expect_words(doubt(scene_of(4000)),
               {"4000 m wide", "millimetre", "--metres-per-unit 0.001 ", "0.0254 for inches"});
  expect_words(doubt(scene_of(1e6)), {"millimetre", "0.001"});
  expect_words(doubt(scene_of(4e6)), {"4000000 m wide", "micrometre", "--metres-per-unit 1e-06"});
  expect_words(doubt(scene_of(0.004)), {"0.004 m wide", "kilometre", "--metres-per-unit 1000"});
  expect_words(doubt(scene_of(4000, "room.toml")), {"[[geometry]]", "metres_per_unit = 0.001"});
}

TEST(DoubtfulUnit, HasNoQuestionOfRooms) {
  for (const double width : {0.051, 0.5, 1000.0}) EXPECT_EQ(doubt(scene_of(width)), "none") << width;
  EXPECT_EQ(doubt(SceneInput{}), "none");
}

TEST(DoubtfulUnit, HasNoQuestionWhereAUnitIsGiven) {
  SceneInput input = scene_of(4000);
  input.geometry[0].unit_given = true;
  EXPECT_EQ(doubt(input), "none");
  input.geometry.push_back({.file = "other.obj"});
  expect_words(doubt(input), {"4000 m wide"});
}

}  // namespace
}  // namespace fluxel::doubtful_unit_test
