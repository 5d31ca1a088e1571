#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/progress.hpp"
#include "scene/cut_patches.hpp"
#include "scene_by_hand.hpp"
#include "tests/unit/messages.hpp"

namespace fluxel {
namespace {

using namespace by_hand;

/// Squares of side 2 in `knots` places, in each so many that all cross one another: where lines cross by
/// chance, a square is cut into about half the square of their number of parts.
Scene knotted(int knots, int squares) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-0.1, 0.1);
  Scene scene = empty_scene(Sides::two);
  for (int knot = 0; knot < knots; ++knot) {
    for (int i = 0; i < squares; ++i) {
      const glm::dquat rotation = random_rotation(random);
      const glm::dvec3 at(5.0 * knot + uniform(random), uniform(random), uniform(random));
      std::vector<glm::dvec3> corner = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
      for (glm::dvec3& x : corner) x = at + rotation * x;
      add(scene, "knot " + std::to_string(knot), corner);
    }
  }
  return scene;
}

TEST(CutLimit, PatchesThatCrossTooOftenAreRefusedByName) {
  Scene scene = knotted(12, 64);
  try {
    cut_patches(scene, connect_patches(scene), true);
    FAIL() << scene.pieces.size() << " pieces";
  } catch (const InputError& error) {
    test_messages::expect_words(error.what(),
                                {"more than 500000 parts of 768 patches", "crossed most are group", "'knot ",
                                 "63 of them the patch around", "--no-cut"});
  }
}

/// Keeps what it is told.
struct ToldProgress final : Progress {
  void begin(const std::string&, double) override {}
  void update(double done, double total, const std::string& detail) override {
    EXPECT_GT(done, last);
    EXPECT_LE(done, total);
    EXPECT_NE(detail.find("patches cut into"), std::string::npos) << detail;
    last = done;
    ++times;
  }
  void update_error(const ErrorProgress&, const std::string&) override {}
  void end() override {}

  double last = 0;
  int times = 0;
};

TEST(CutLimit, TellsHowFarALongCutIs) {
  ToldProgress progress;
  Scene scene = knotted(2, 40);
  cut_patches(scene, connect_patches(scene), true, 2, &progress);
  EXPECT_GE(progress.times, 2);
  Scene few = knotted(1, 4);
  ToldProgress silent;
  cut_patches(few, connect_patches(few), true, 2, &silent);
  EXPECT_EQ(silent.times, 0);
}

}  // namespace
}  // namespace fluxel
