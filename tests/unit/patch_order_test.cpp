#include "scene/patch_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <set>

#include "scene_by_hand.hpp"

namespace fluxel {
namespace {

using namespace by_hand;
using Cell = std::array<std::uint32_t, 3>;

TEST(PatchOrder, CellsAlongTheCurveShareAFace) {
  // The coarse cells of the curve are cubes of 2^17 cells: 16 a side.
  std::map<std::uint64_t, Cell> curve;
  for (std::uint32_t x = 0; x < 16; ++x) {
    for (std::uint32_t y = 0; y < 16; ++y) {
      for (std::uint32_t z = 0; z < 16; ++z)
        curve[hilbert_key({x << 17, y << 17, z << 17}) >> 51] = {x, y, z};
    }
  }
  ASSERT_EQ(curve.size(), 4096u);
  const Cell* before = nullptr;
  for (const auto& [key, cell] : curve) {
    if (before != nullptr) {
      int steps = 0;
      for (std::size_t i = 0; i < 3; ++i)
        steps += std::abs(static_cast<int>(cell[i]) - static_cast<int>((*before)[i]));
      EXPECT_EQ(steps, 1);
    }
    before = &cell;
  }
}

TEST(PatchOrder, ConsecutiveCellsOfTheFinestLevelAreNeighbours) {
  std::map<std::uint64_t, Cell> curve;
  for (std::uint32_t x = 0; x < 8; ++x) {
    for (std::uint32_t y = 0; y < 8; ++y) {
      for (std::uint32_t z = 0; z < 8; ++z) curve[hilbert_key({x, y, z})] = {x, y, z};
    }
  }
  ASSERT_EQ(curve.size(), 512u);
  EXPECT_EQ(curve.begin()->first, 0u);
  EXPECT_EQ(curve.rbegin()->first, 511u);
}

TEST(PatchOrder, RoundingOrdersNoPatches) {
  // Pairs of patches at the same place but for rounding, at fractions of the box where cells meet.
  Scene scene = empty_scene(Sides::two);
  for (int i = 0; i <= 7; ++i)
    for (const double rounded : {1 + 1e-15, 1 - 1e-15}) {
      const double x = i * rounded;
      add(scene, "pair", {{x - 0.1, 0, 0}, {x + 0.1, -0.1, 0}, {x, 0.1, 0}});
      scene.pieces.push_back(
          {scene.patches.back().outline, PatchId{static_cast<std::uint32_t>(scene.pieces.size())}});
    }
  order_pieces(scene);
  for (std::size_t k = 0; k < scene.pieces.size(); k += 2)
    EXPECT_EQ(index(scene.pieces[k].patch) + 1, index(scene.pieces[k + 1].patch));
}

TEST(PatchOrder, PiecesOfAPatchStayTogetherInTheirOrder) {
  Scene scene = empty_scene(Sides::two);
  for (int i = 0; i < 40; ++i) {
    const double x = (i * 7) % 40;
    add(scene, "strip", {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}});
  }
  for (std::uint32_t part = 0; part < 3; ++part) {
    for (std::uint32_t patch = 0; patch < 40; ++patch) {
      Piece piece{scene.patches[patch].outline, PatchId{patch}};
      piece.outline.corner[3].x = part;
      scene.pieces.push_back(piece);
    }
  }
  order_pieces(scene);
  ASSERT_EQ(scene.pieces.size(), 120u);
  std::set<PatchId> seen;
  for (std::size_t i = 0; i < 120; ++i) {
    EXPECT_EQ(scene.pieces[i].outline.corner[3].x, static_cast<double>(i % 3));
    if (i % 3 == 0) {
      EXPECT_TRUE(seen.insert(scene.pieces[i].patch).second);
    } else {
      EXPECT_EQ(scene.pieces[i].patch, scene.pieces[i - 1].patch);
    }
  }
}

TEST(PatchOrder, PatchesOfOnePlaceFollowTheirNumbers) {
  Scene scene = empty_scene(Sides::two);
  for (std::uint32_t i = 0; i < 5; ++i) {
    add(scene, "same", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    scene.pieces.insert(scene.pieces.begin(), Piece{scene.patches[i].outline, PatchId{i}});
  }
  order_pieces(scene);
  for (std::uint32_t i = 0; i < 5; ++i) EXPECT_EQ(scene.pieces[i].patch, PatchId{i});
}

}  // namespace
}  // namespace fluxel
