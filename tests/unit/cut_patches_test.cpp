#include "scene/cut_patches.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "scene/contact_pairs.hpp"
#include "scene_by_hand.hpp"
#include "tests/closed_forms/shapes.hpp"

namespace fluxel {
namespace {

using namespace by_hand;

/// The widest of all pieces' reach to the lesser of their two sides of a plane [m].
double straddling(const Scene& scene, const Plane& plane) {
  double most = 0;
  for (const Piece& piece : scene.pieces) {
    double front = 0, back = 0;
    for (const glm::dvec3& x : corners(piece.outline)) {
      front = std::max(front, plane.distance(x));
      back = std::max(back, -plane.distance(x));
    }
    most = std::max(most, std::min(front, back));
  }
  return most;
}

/// `touching`: what bodies and others touch each other by, of both [m2].
void expect_areas_add_up(const Scene& scene, double touching = 0) {
  double patches = 0, pieces = 0;
  for (const Patch& patch : scene.patches) patches += patch.area;
  for (const Piece& piece : scene.pieces) {
    const glm::dvec3 vector = area_vector(corners(piece.outline));
    EXPECT_GT(glm::dot(vector, scene.patch(piece.patch).normal), 0);
    pieces += glm::length(vector);
  }
  EXPECT_NEAR(pieces, patches - scene.statistics.covered_area - touching, 1e-12 * patches);
}

PatchId add_floor(Scene& scene) { return add(scene, "floor", {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}}); }

TEST(CutPatches, AWallCutsTheFloorItStandsOn) {
  Scene scene = empty_scene(Sides::two);
  const PatchId floor = add_floor(scene);
  const PatchId wall = add(scene, "wall", {{1, 0, 0}, {1, 4, 0}, {1, 4, 3}, {1, 0, 3}});
  cut_patches(scene, connect_patches(scene), true);
  ASSERT_EQ(pieces_of(scene, floor).size(), 2u);
  for (const auto& piece : pieces_of(scene, floor)) EXPECT_EQ(piece.corners, 4u);
  EXPECT_EQ(pieces_of(scene, wall).size(), 1u);
  EXPECT_EQ(straddling(scene, {{1, 0, 0}, {1, 0, 0}}), 0);
  EXPECT_EQ(scene.statistics.cut_patches, 1u);
  EXPECT_EQ(scene.notes.size(), 1u);
  expect_areas_add_up(scene);
}

TEST(CutPatches, AWallThatEndsInsideCutsOnlyWhatItCrosses) {
  Scene scene = empty_scene(Sides::two);
  const PatchId floor = add_floor(scene);
  add(scene, "wall", {{1, 0, 0}, {1, 4, 0}, {1, 4, 3}, {1, 0, 3}});
  add(scene, "wing", {{1, 2, 0}, {2, 2, 0}, {2, 2, 1}, {1, 2, 1}});
  cut_patches(scene, connect_patches(scene), true);
  EXPECT_EQ(pieces_of(scene, floor).size(), 3u);  // the wing's line is not drawn beyond the wall
  expect_areas_add_up(scene);
}

TEST(CutPatches, AWallCutsTheFloorAcrossANarrowGapOnly) {
  for (const double gap : {1e-4, 0.3, 0.4, 2.0}) {
    Scene scene = empty_scene(Sides::two);
    const PatchId floor = add_floor(scene);
    add(scene, "wall", {{1, 0, gap}, {1, 4, gap}, {1, 4, 3 + gap}, {1, 0, 3 + gap}});  // 3 m high
    cut_patches(scene, connect_patches(scene), true);
    const bool narrow = gap < 3.0 / 8;
    EXPECT_EQ(pieces_of(scene, floor).size(), narrow ? 2u : 1u) << gap;
    EXPECT_EQ(scene.statistics.cut_patches, narrow ? 1u : 0u) << gap;
    if (narrow) {
      EXPECT_NEAR(straddling(scene, {{1, 0, 0}, {1, 0, 0}}), 0, 1e-15);
    }
    expect_areas_add_up(scene);
  }
}

TEST(CutPatches, WhatHoversCutsTheSideThatItIsBeforeWhereThatIsUsed) {
  for (const Sides sides : {Sides::one, Sides::two}) {
    for (const double height : {0.01, -0.01}) {
      Scene scene = empty_scene(sides);
      const PatchId floor = add_floor(scene);
      add(scene, "plate", {{1, 1, height}, {1, 3, height}, {3, 3, height}, {3, 1, height}});
      cut_patches(scene, connect_patches(scene), true);
      const bool cut = height > 0 || sides == Sides::two;
      EXPECT_EQ(pieces_of(scene, floor).size(), cut ? 5u : 1u) << height;
      double covered = 0;
      for (const auto& piece : pieces_of(scene, floor)) {
        const glm::dvec3 x = centroid(corners(piece));
        if (x.x > 1 && x.x < 3 && x.y > 1 && x.y < 3) covered += area(corners(piece));
      }
      if (cut) {
        EXPECT_NEAR(covered, 4, 1e-12);
      }
      expect_areas_add_up(scene);
    }
  }
}

TEST(CutPatches, NoStripIsCutOffThatIsNarrowerThanTwiceTheGap) {
  for (const double margin : {0.015, 0.025}) {
    Scene scene = empty_scene(Sides::two);
    const PatchId floor = add_floor(scene);
    const double high = 4 - margin;
    add(scene, "plate", {{-1, -1, 0.01}, {high, -1, 0.01}, {high, 5, 0.01}, {-1, 5, 0.01}});
    cut_patches(scene, connect_patches(scene), true);
    EXPECT_EQ(pieces_of(scene, floor).size(), margin < 0.02 ? 1u : 2u);
  }
}

TEST(CutPatches, OfWhatSlopesAwayOnlyTheNearEdgeCuts) {
  Scene scene = empty_scene(Sides::two);
  const PatchId floor = add_floor(scene);
  add(scene, "ramp", {{1, 1, 0.01}, {3, 1, 2}, {3, 3, 2}, {1, 3, 0.01}});
  cut_patches(scene, connect_patches(scene), true);
  EXPECT_EQ(pieces_of(scene, floor).size(), 2u) << "by the lower edge alone";
}

TEST(CutPatches, WithoutCuttingTheFloorStaysWhole) {
  Scene scene = empty_scene(Sides::two);
  const PatchId floor = add_floor(scene);
  add(scene, "wall", {{1, 0, 0}, {1, 4, 0}, {1, 4, 3}, {1, 0, 3}});
  cut_patches(scene, connect_patches(scene), false);
  EXPECT_EQ(pieces_of(scene, floor).size(), 1u);
}

TEST(CutPatches, CrossingQuadsCutEachOther) {
  Scene scene = empty_scene(Sides::two);
  const PatchId flat = add(scene, "flat", {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
  const PatchId upright = add(scene, "upright", {{0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1}});
  cut_patches(scene, connect_patches(scene), true);
  for (const PatchId patch : {flat, upright}) {
    const auto pieces = pieces_of(scene, patch);
    ASSERT_EQ(pieces.size(), 2u);
    EXPECT_DOUBLE_EQ(area(corners(pieces[0])), 2);
    EXPECT_DOUBLE_EQ(area(corners(pieces[1])), 2);
  }
}

TEST(CutPatches, CrossingAtATinyAngleIsCutWhereTheyMeet) {
  for (const double slope : {1e-2, 1e-4, 1e-5}) {
    Scene scene = empty_scene(Sides::two);
    const PatchId flat = add(scene, "flat", {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
    add(scene, "sloping", {{-1, -1, -slope}, {1, -1, slope}, {1, 1, slope}, {-1, 1, -slope}});
    cut_patches(scene, connect_patches(scene), true);
    ASSERT_EQ(pieces_of(scene, flat).size(), 2u) << slope;
    EXPECT_LT(straddling(scene, {{0, 0, 0}, {1, 0, 0}}), 1e-10);
    expect_areas_add_up(scene);
  }
}

TEST(CutPatches, ABoxOnAFloorPartsWhatIsUnderIt) {
  for (const bool with_bottom : {true, false}) {
    Scene scene = empty_scene(Sides::one);
    const PatchId floor = add_floor(scene);
    const PatchId bottom = add_box(scene, "box", {1, 1, 0}, {2, 3, 1}, true);
    if (!with_bottom) scene.patches.erase(scene.patches.begin() + static_cast<std::ptrdiff_t>(index(bottom)));
    cut_patches(scene, connect_patches(scene), true);
    double under = 0;
    for (const auto& piece : pieces_of(scene, floor)) {
      const glm::dvec3 c = centroid(corners(piece));
      if (c.x < 1 || c.x > 2 || c.y < 1 || c.y > 3) continue;
      under += area(corners(piece));
    }
    EXPECT_DOUBLE_EQ(under, with_bottom ? 0 : 2) << "a bottom and what is below it see nothing";
    EXPECT_EQ(pieces_of(scene, floor).size(), with_bottom ? 4u : 5u);
    EXPECT_EQ(pieces_of(scene, bottom).size(), with_bottom ? 0u : 1u);
    EXPECT_EQ(scene.statistics.coplanar_overlaps, 0u);
    expect_areas_add_up(scene, with_bottom ? 4 : 0);
  }
}

// The walls of two rooms are back to back, though they lie as a box and its floor do.
TEST(CutPatches, RoomsBesideEachOtherKeepTheirWalls) {
  Scene scene = empty_scene(Sides::one);
  for (const auto& [low, high] :
       {std::pair<glm::dvec3, glm::dvec3>{{0, 0, 0}, {2, 3, 2}}, {{2, 0, 0}, {5, 3, 2}}})
    for (const closed_forms::Polygon& face : closed_forms::reversed(closed_forms::box(low, high)))
      add(scene, "room", face);
  cut_patches(scene, connect_patches(scene), true);
  expect_areas_add_up(scene);
  EXPECT_EQ(scene.pieces.size(), 12u);
}

TEST(CutPatches, ABoxLeftWholeByItsOwnFaces) {
  Scene scene = empty_scene(Sides::two);
  add_box(scene, "box", {1, 1, 0}, {2, 3, 1}, true);
  cut_patches(scene, connect_patches(scene), true);
  EXPECT_EQ(scene.pieces.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(scene.pieces[i].patch, PatchId{static_cast<std::uint32_t>(i)});
    EXPECT_EQ(scene.pieces[i].outline.corner, scene.patches[i].outline.corner);
  }
}

TEST(CutPatches, InterpenetratingBoxesAreParted) {
  Scene scene = empty_scene(Sides::two);
  add_box(scene, "one", {0, 0, 0}, {2, 2, 2}, true);
  add_box(scene, "two", {1, 1, 1}, {3, 3, 3}, true);
  cut_patches(scene, connect_patches(scene), true);
  double inside_one = 0;
  for (const Piece& piece : scene.pieces) {
    const glm::dvec3 c = centroid(corners(piece.outline));
    if (std::max({c.x, c.y, c.z}) < 2 && std::min({c.x, c.y, c.z}) > 0)
      inside_one += area(corners(piece.outline));
  }
  EXPECT_NEAR(inside_one, 3, 1e-14);  // three unit squares of the second box
  EXPECT_EQ(scene.statistics.cut_patches, 6u);
  expect_areas_add_up(scene);
}

TEST(CutPatches, ALightInTheCeilingTakesItsAreaFromIt) {
  for (const Sides sides : {Sides::one, Sides::two}) {
    Scene scene = empty_scene(sides);
    const PatchId ceiling =
        add(scene, "ceiling", {{556, 548.8, 0}, {556, 548.8, 559.2}, {0, 548.8, 559.2}, {0, 548.8, 0}});
    const PatchId light = add(
        scene, "light", {{343, 548.8, 227}, {343, 548.8, 332}, {213, 548.8, 332}, {213, 548.8, 227}}, kLight);
    cut_patches(scene, connect_patches(scene), true);
    EXPECT_EQ(scene.statistics.coplanar_overlaps, 1u);
    EXPECT_NEAR(scene.statistics.covered_area, 13650, 1e-10);
    EXPECT_NEAR(piece_area(scene, ceiling), 556 * 559.2 - 13650, 1e-9);
    EXPECT_EQ(pieces_of(scene, ceiling).size(), 4u);
    EXPECT_EQ(pieces_of(scene, light).size(), 1u);
    ASSERT_EQ(scene.notes.size(), 2u);
    EXPECT_NE(scene.notes[0].find("'light' lies in the plane of 'ceiling' and covers 13650 m2"),
              std::string::npos);
    expect_areas_add_up(scene);
  }
}

TEST(CutPatches, ADuplicateIsNamedAndLeftOut) {
  Scene scene = empty_scene(Sides::two);
  const PatchId first = add(scene, "first", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  const PatchId second = add(scene, "second", {{1, 0, 0}, {0, 1, 0}, {0, 0, 0}});
  const PatchId turned = add(scene, "turned", {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}});
  cut_patches(scene, connect_patches(scene), true);
  EXPECT_EQ(pieces_of(scene, first).size(), 1u);
  EXPECT_TRUE(pieces_of(scene, second).empty());
  EXPECT_TRUE(pieces_of(scene, turned).empty());
  EXPECT_EQ(scene.statistics.coplanar_overlaps, 3u);
  EXPECT_DOUBLE_EQ(scene.statistics.covered_area, 1);
  const auto names = [&](const std::string& group) {
    return std::any_of(scene.notes.begin(), scene.notes.end(), [&](const std::string& note) {
      return note.find("a patch of '" + group + "' is wholly covered") != std::string::npos;
    });
  };
  EXPECT_TRUE(names("second"));
  EXPECT_TRUE(names("turned"));
  EXPECT_FALSE(names("first"));
}

TEST(CutPatches, TheEmitterOfTwoDuplicatesWins) {
  Scene scene = empty_scene(Sides::two);
  const PatchId first = add(scene, "first", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  const PatchId lamp = add(scene, "lamp", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, kLight);
  cut_patches(scene, connect_patches(scene), true);
  EXPECT_TRUE(pieces_of(scene, first).empty());
  EXPECT_EQ(pieces_of(scene, lamp).size(), 1u);
}

TEST(CutPatches, BackToBackSheetsKeepBoth) {
  Scene scene = empty_scene(Sides::one);
  const PatchId up = add(scene, "up", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  const PatchId down = add(scene, "down", {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}});
  cut_patches(scene, connect_patches(scene), true);
  EXPECT_EQ(pieces_of(scene, up).size(), 1u);
  EXPECT_EQ(pieces_of(scene, down).size(), 1u);
  EXPECT_EQ(scene.statistics.coplanar_overlaps, 0u);
}

TEST(CutPatches, RimsOfASheetGetNoPiece) {
  for (const Sides sides : {Sides::one, Sides::two}) {
    Scene scene = empty_scene(sides);
    add_floor(scene);
    const PatchId bottom = add_box(scene, "sheet", {1, 1, 0}, {1 + 1e-7, 3, 1}, true);
    const PatchId strip = add(scene, "strip", {{3, 1, 1}, {3, 3, 1}, {3 + 1e-7, 3, 1}}, kLight);
    cut_patches(scene, connect_patches(scene), true);
    const std::size_t pieces = sides == Sides::two ? 0 : 1;
    EXPECT_EQ(pieces_of(scene, bottom).size(), pieces);
    EXPECT_EQ(pieces_of(scene, strip).size(), 1u) << "an emitter is kept";
    EXPECT_EQ(std::any_of(scene.notes.begin(), scene.notes.end(),
                          [](const std::string& note) {
                            return note.find("4 two-sided patches are narrower than") != std::string::npos;
                          }),
              sides == Sides::two);
  }
}

TEST(CutPatches, NotesOfManyGroupsAreCapped) {
  Scene scene = empty_scene(Sides::two);
  for (int i = 0; i < 30; ++i) {
    const double x = 2 * i;
    add(scene, "a" + std::to_string(i), {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}});
    add(scene, "b" + std::to_string(i), {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}});
  }
  cut_patches(scene, connect_patches(scene), true);
  EXPECT_EQ(scene.notes.size(), 22u);
  EXPECT_EQ(scene.notes[10].substr(0, 11), "... and 20 ");
}

/// Two rooms behind one another, 8 x 4 x 3 m, with an oblique wall between them from side to side.
TEST(CutPatches, NoPieceLiesInTwoRooms) {
  std::mt19937 random(1);
  for (const double thickness : {0.0, 8e-6, 8e-3}) {
    for (int turn = 0; turn < 20; ++turn) {
      Scene scene = empty_scene(Sides::two);
      add_box(scene, "shell", {0, 0, 0}, {8, 4, 3}, false);
      const auto wall = [&](double x) {
        add(scene, "wall", {{x, 0, 0}, {x + 1, 4, 0}, {x + 1, 4, 3}, {x, 0, 3}});
        return Plane{scene.patches.back().outline.corner[0], scene.patches.back().normal};
      };
      std::vector<Plane> planes{wall(3)};
      if (thickness > 0) planes.push_back(wall(3 + thickness));
      const glm::dquat rotation = random_rotation(random);
      rotate(scene, rotation);
      cut_patches(scene, connect_patches(scene), true);
      for (const Plane& plane : planes) {
        EXPECT_LE(straddling(scene, {rotation * plane.point, rotation * plane.normal}),
                  contact_tolerance(scene));
      }
      EXPECT_EQ(scene.statistics.cut_patches, 4u);
      expect_areas_add_up(scene);
    }
  }
}

TEST(CutPatches, APartTooNarrowForRaysIsNotCutOff) {
  for (const double gaps : {1.5, 2.5}) {
    Scene scene = empty_scene(Sides::two);
    const PatchId floor = add_floor(scene);
    add(scene, "back", {{1, 0, 0}, {1, 4, 0}, {1, 4, 3}, {1, 0, 3}});
    const double x = 1 + gaps * contact_tolerance(scene);
    add(scene, "front", {{x, 0, 0}, {x, 4, 0}, {x, 4, 3}, {x, 0, 3}});
    cut_patches(scene, connect_patches(scene), true);
    EXPECT_EQ(pieces_of(scene, floor).size(), gaps < 2 ? 2u : 3u);
    expect_areas_add_up(scene);
  }
}

TEST(CutPatches, RandomTrianglesAreNowhereCrossedAfterwards) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const unsigned seed : {7u, 8u, 9u}) {
    std::mt19937 random(seed);
    Scene scene = empty_scene(Sides::two);
    for (int i = 0; i < 60; ++i) {
      Polygon corner;
      for (int k = 0; k < 3; ++k) corner.emplace_back(uniform(random), uniform(random), uniform(random));
      add(scene, "soup", corner);
    }
    cut_patches(scene, connect_patches(scene), true);
    EXPECT_GT(scene.statistics.cut_patches, 50u);
    expect_areas_add_up(scene);
    // The pieces as patches of a new scene touch each other along their outlines alone.
    Scene again = empty_scene(Sides::two);
    for (const Piece& piece : scene.pieces) {
      const PolygonView outline = corners(piece.outline);
      add(again, "piece", {outline.begin(), outline.end()});
    }
    const auto left = find_contact_pairs(again, 2 * contact_tolerance(again), true, 2).contacts;
    EXPECT_TRUE(std::ranges::none_of(left, [](const Contact& contact) { return contact.gap == 0; }));
  }
}

// Both are of one plane for a scene of 800 m: what lies in front of the light covers it, where that is no
// rounding, and the scene warns.
TEST(CutPatches, WhatLiesInFrontOfALightCoversIt) {
  for (const double gap : {0.001, 1e-5, 0.0, -0.001}) {
    Scene scene = empty_scene(Sides::one);
    const PatchId ground =
        add(scene, "ground", {{-400, -400, 0}, {400, -400, 0}, {400, 400, 0}, {-400, 400, 0}}, kLight);
    const PatchId floor = add(scene, "floor", {{0, 0, gap}, {4, 0, gap}, {4, 4, gap}, {0, 4, gap}});
    cut_patches(scene, connect_patches(scene), true);
    const bool floor_covers = gap == 0.001;
    EXPECT_EQ(pieces_of(scene, floor).size(), floor_covers ? 1u : 0u) << gap;
    EXPECT_EQ(pieces_of(scene, ground).size(), floor_covers ? 4u : 1u) << gap;
    EXPECT_EQ(scene.warnings.size(), std::abs(gap) > 1e-4 ? 1u : 0u) << gap;
    expect_areas_add_up(scene);
  }
}

}  // namespace
}  // namespace fluxel
