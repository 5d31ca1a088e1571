#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "bench/stability/rooms.hpp"
#include "bench/stability/situation_lists.hpp"
#include "tests/stability/world.hpp"

namespace fluxel::lab {
namespace {

using test::world;

Situation named(const std::vector<Situation>& list, const std::string& name) {
  const auto found = std::ranges::find_if(list, [&](const Situation& s) { return s.name == name; });
  if (found == list.end()) throw std::out_of_range(name);
  return *found;
}

struct ThinWall {
  Wall wall;
  Sides sides;
  double thickness;
  const char* name;
};

class DarkRoomBehind : public testing::TestWithParam<ThinWall> {};

// Every method that looks past the centroids has rays of its own, so the rule with them stands for all.
TEST_P(DarkRoomBehind, IsDarkInEveryRotation) {
  const auto [wall, sides, thickness, name] = GetParam();
  for (const std::string method : {"point", "adaptive"}) {
    for (unsigned rotation = 0; rotation < 100; ++rotation) {
      const DarkRoom room = dark_room(wall, thickness, sides, rotation);
      const lab::Run result = run(world(), room.setup, method_named(method));
      ASSERT_EQ(leak(room, result), 0) << method << ", rotation " << rotation;
      ASSERT_GT(result.mean_B("wall"), 0.05) << "the lit side is dark too";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Wall, DarkRoomBehind,
                         testing::Values(ThinWall{Wall::sheet, Sides::two, 0, "sheet"},
                                         ThinWall{Wall::two_faces, Sides::one, 0, "two_faces_0"},
                                         ThinWall{Wall::two_faces, Sides::one, 1e-6, "two_faces_1e6"},
                                         ThinWall{Wall::two_faces, Sides::one, 1e-3, "two_faces_1e3"},
                                         ThinWall{Wall::box, Sides::one, 1e-6, "box_1e6"},
                                         ThinWall{Wall::box, Sides::one, 1e-3, "box_1e3"},
                                         ThinWall{Wall::box, Sides::two, 1e-6, "two_sided_box_1e6"},
                                         ThinWall{Wall::box, Sides::two, 1e-3, "two_sided_box_1e3"}),
                         [](const auto& of) { return of.param.name; });

// Both sides of a thin wall keep their light: the same rooms as furnaces.
TEST(ThinWall, LosesNoLightOnEitherSide) {
  for (const Sides sides : {Sides::one, Sides::two}) {
    for (const double thickness : {1e-7, 1e-6, 1.3e-6, 2e-6, 1e-5, 1e-3}) {
      lab::Setup setup = dark_room(Wall::box, thickness, sides, 1).setup;
      setup.adjust = [](const ElementMesh&, Unknowns& unknowns) {
        std::ranges::fill(unknowns.rho, Rgb(0.5));
        std::ranges::fill(unknowns.E, Rgb(0.5));
      };
      const lab::Run result = run(world(), setup, method_named("adaptive"));
      EXPECT_NEAR(result.mean_B("shell"), 1, 2e-3) << thickness;
    }
  }
}

TEST(DarkRoom, LeaksWhereNothingIsCut) {
  for (const Method& method : methods()) {
    DarkRoom room = dark_room(Wall::sheet, 0, Sides::two, 1);
    room.setup.cut = false;
    const double leaked = leak(room, run(world(), room.setup, method));
    std::printf("%s without cutting: %.2e of the light's E in the dark room\n", method.name.c_str(), leaked);
    EXPECT_GT(leaked, 0) << method.name;
    EXPECT_LT(leaked, 0.02) << method.name;
  }
}

TEST(OnePlane, PairsExchangeExactlyNothing) {
  const Situation situation = named(coincidence_situations(), "side-by-side");
  for (const Method& method : methods())
    EXPECT_EQ(situation.measure(world(), method, 0).error, 0) << method.name;
}

TEST(OnePlane, DuplicatesAreNamedAndNotDoubled) {
  lab::Setup setup;
  setup.sides = Sides::two;
  for (const std::string group : {"original", "copy"})
    add_box(setup.input, group, 0.5, 0.5, glm::dvec3(0), glm::dvec3(1), false);
  setup.subdivision = Subdivision::uniform;
  setup.max_edge = 0.25;
  const lab::Run result = run(world(), setup, method_named("adaptive"));
  const std::string notes = [&] {
    std::string all;
    for (const std::string& note : result.scene.notes) all += note + '\n';
    return all;
  }();
  EXPECT_NE(notes.find("'original' lies in the plane of 'copy' and covers 6 m2"), std::string::npos) << notes;
  EXPECT_NE(notes.find("6 patches of 'copy' are wholly covered"), std::string::npos) << notes;
  EXPECT_EQ(result.mesh.elements.size(), 6u * 16u);
  // The means over fronts alone: the light is inside.
  EXPECT_NEAR(result.mean_B("original"), 1, 1e-3);
}

TEST(OnePlane, DoublesAreSeenOnceAtEveryGap) {
  const Situation situation = named(coincidence_situations(), "duplicates");
  for (const double gap : {0.0, 1e-8, 3e-7, 1e-6, 1e-5})
    EXPECT_LE(situation.measure(world(), method_named("adaptive"), gap).error, 1e-3) << gap;
}

// The floor's irradiance changes with the lamp's height as it must, by 4e-5 for a centimetre, and by no more.
TEST(OnePlane, ALightLiesInTheCeilingOrJustBelow) {
  const Situation situation = named(coincidence_situations(), "light-in-ceiling");
  const Method adaptive = method_named("adaptive");
  const double in_plane = situation.measure(world(), adaptive, 0).error;
  EXPECT_LE(in_plane, 1e-4);
  for (const double gap : {1e-8, 3e-7, 1e-6, 0.01 / 559.2})
    EXPECT_NEAR(situation.measure(world(), adaptive, gap).error, in_plane, 1e-6) << gap;
}

TEST(Furnace, ShiftAndScaleChangeItByRoundingAlone) {
  constexpr double kRounding = 0x1p-24;
  const std::vector<Situation> list = leak_situations();
  for (const Method& method : methods()) {
    double shifted = 0, scaled = 0;
    for (const double shift : {1.0, 1e3, 1e5})
      shifted = std::max(shifted, named(list, "shift").measure(world(), method, shift).error);
    for (const double scale : {1e-3, 0.1, 10.0, 1e3})
      scaled = std::max(scaled, named(list, "scale").measure(world(), method, scale).error);
    std::printf("%s: shift changes %.1f roundings, scale %.1f\n", method.name.c_str(), shifted / kRounding,
                scaled / kRounding);
    EXPECT_LE(shifted, kRounding) << method.name;
    EXPECT_LE(scaled, 15 * kRounding) << method.name;
  }
}

TEST(Windings, DoNotMatterWhereBothSidesTakePart) {
  const Situation situation = named(topology_situations(), "flipped-two-sided");
  for (const Method& method : methods())
    EXPECT_LE(situation.measure(world(), method, 0.5).error, 1e-12) << method.name;
}

TEST(Windings, TurnedOneSidedPatchesAreDark) {
  const Situation situation = named(topology_situations(), "flipped-one-sided");
  EXPECT_EQ(situation.measure(world(), method_named("adaptive"), 0.5).error, 1);
}

TEST(TJunctions, LetNoRayEscape) {
  const Situation situation = named(topology_situations(), "t-junctions");
  for (int rotation = 0; rotation < 100; ++rotation) {
    // Infinite where one does.
    const Measurement found = situation.measure(world(), method_named("adaptive"), rotation);
    EXPECT_LE(found.error, 1e-3) << rotation;
  }
}

TEST(EmptyRows, StayAsTheyEmit) {
  const Situation situation = named(topology_situations(), "empty-rows");
  for (const Method& method : {method_named("adaptive"), method_named("adaptive, closure")})
    EXPECT_LE(situation.measure(world(), method, 10).error, 1e-3) << method.name;
}

TEST(NothingEmits, NothingIsLit) {
  lab::Setup setup;
  add_box(setup.input, "room", 0.5, 0, glm::dvec3(0), glm::dvec3(1), false);
  for (const Method& method : methods()) {
    const lab::Run result = run(world(), setup, method);
    EXPECT_TRUE(result.radiosity.converged) << method.name;
    for (const Rgb& B : result.radiosity.B) EXPECT_EQ(B, Rgb(0)) << method.name;
  }
}

}  // namespace
}  // namespace fluxel::lab
