#include "subdivision/piece_finder.hpp"

#include <gtest/gtest.h>

#include <random>
#include <utility>

#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

/// A unit square in n x n pieces, and one of a single piece above it.
Scene in_pieces(int n) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "cut", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  by_hand::add(scene, "whole", {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}});
  scene.extent = 1;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const glm::dvec3 low(1.0 * i / n, 1.0 * j / n, 0), u(1.0 / n, 0, 0), v(0, 1.0 / n, 0);
      scene.pieces.push_back({{{low, low + u, low + u + v, low + v}, 4}, PatchId{0}});
    }
  scene.pieces.push_back({scene.patches[1].outline, PatchId{1}});
  return scene;
}

TEST(PieceFinder, FindsWhereAPointLies) {
  for (const int n : {1, 2, 3, 20}) {
    const Scene scene = in_pieces(n);
    const PieceFinder finder(scene);
    std::mt19937 random(1);
    for (int k = 0; k < 2000; ++k) {
      const double x = test_scenes::uniform(random, 0, 1), y = test_scenes::uniform(random, 0, 1);
      EXPECT_EQ(finder.find(PatchId{0}, {x, y, 0}),
                static_cast<std::size_t>(static_cast<int>(x * n) * n + static_cast<int>(y * n)))
          << n;
      EXPECT_EQ(finder.find(PatchId{1}, {x, y, 1}), static_cast<std::size_t>(n * n));
    }
  }
}

// Rounding may put a point beside its patch, and on a cut several pieces are as good.
TEST(PieceFinder, FindsSomethingForEveryPoint) {
  const Scene scene = in_pieces(4);
  const PieceFinder finder(scene);
  EXPECT_EQ(finder.find(PatchId{0}, {-1e-12, 0.1, 0}), 0U);
  EXPECT_EQ(finder.find(PatchId{0}, {-0.1, 0.1, 0}), 0U);
  EXPECT_EQ(finder.find(PatchId{0}, {1.1, 0.9, 0}), 15U);
  EXPECT_EQ(finder.find(PatchId{0}, {0.25, 0.1, 0}), 0U) << "the lower one has the cut";
}

TEST(PieceFinder, FindsNoneOfAPatchThatOnlyStandsInTheWay) {
  Scene scene = in_pieces(3);
  std::erase_if(scene.pieces, [](const Piece& piece) { return index(piece.patch) == 1; });
  const PieceFinder finder(scene);
  EXPECT_EQ(finder.find(PatchId{1}, {0.5, 0.5, 1}), PieceFinder::kNone);
}

}  // namespace
}  // namespace fluxel
