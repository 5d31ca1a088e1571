#include "subdivision/plane_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using test_scenes::uniform;

/// Outlines of all sizes in a plane, and the normal of that.
struct Outlines {
  std::vector<Outline<glm::dvec3>> all;
  glm::dvec3 normal;

  Outlines(std::mt19937& random, std::size_t count) {
    const glm::dvec3 along =
        glm::normalize(glm::dvec3(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)));
    normal = glm::normalize(glm::cross(along, glm::dvec3(0.3, -0.2, 1)));
    const glm::dvec3 across = glm::cross(normal, along);
    for (std::size_t k = 0; k < count; ++k) {
      const double size = std::exp2(uniform(random, -8, 1));
      const glm::dvec3 at = uniform(random, 0, 3) * along + uniform(random, 0, 2) * across;
      all.push_back({{at, at + size * along, at + size * (along + across), at + size * across}, 4});
    }
  }
};

TEST(PlaneGrid, NamesAllWhoseBoxHoldsAPoint) {
  constexpr double kMargin = 1e-3;
  std::mt19937 random(6);
  for (const std::size_t count : {1U, 2U, 50U, 3000U}) {
    const Outlines outlines(random, count);
    std::vector<PlaneGrid::Entry> entries;
    for (std::size_t k = 0; k < count; ++k)
      entries.push_back(PlaneGrid::entry(outlines.all[k], kMargin, static_cast<std::uint32_t>(1000 + k)));
    const PlaneGrid grid(entries, outlines.normal);
    std::size_t named = 0;
    constexpr std::size_t kPoints = 300;
    for (std::size_t k = 0; k < kPoints; ++k) {
      // Corners are on the edges of boxes.
      const glm::dvec3 point = outlines.all[random() % count].corner[k % 4];
      const auto around = grid.around(point);
      named += around.size();
      for (const PlaneGrid::Entry& entry : entries)
        if (glm::all(glm::lessThanEqual(entry.low, point)) &&
            glm::all(glm::lessThanEqual(point, entry.high))) {
          EXPECT_NE(std::ranges::find(around, entry.number), around.end());
        }
    }
    if (count > 1000) {
      EXPECT_LT(named, 0.1 * kPoints * static_cast<double>(count));
    }
  }
}

TEST(PlaneGrid, PointsBeyondItHaveTheNearestCell) {
  const Outline<glm::dvec3> square{{glm::dvec3(0, 0, 0), {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 4};
  const PlaneGrid grid(std::vector{PlaneGrid::entry(square, 0, 7)}, {0, 0, 1});
  for (const double far : {-1e300, -5.0, 0.5, 9.0, 1e300})
    EXPECT_EQ(grid.around({far, -far, far}).front(), 7u);
}

}  // namespace
}  // namespace fluxel
