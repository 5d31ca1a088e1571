#include "hierarchy/solid_angle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

Outline<glm::dvec3> triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  Outline<glm::dvec3> made;
  made.corner[0] = a, made.corner[1] = b, made.corner[2] = c;
  made.corners = 3;
  return made;
}

Outline<glm::dvec3> square() {
  Outline<glm::dvec3> made;
  made.corner = {glm::dvec3(-1, -1, 0), glm::dvec3(1, -1, 0), glm::dvec3(1, 1, 0), glm::dvec3(-1, 1, 0)};
  made.corners = 4;
  return made;
}

TEST(SeenFace, HasTheSolidAngleOfClosedForms) {
  // An octant, and a face of a cube from its middle.
  EXPECT_NEAR(SeenFace(triangle({1, 0, 0}, {0, 1, 0}, {0, 0, 1}), {0, 0, 0}).solid_angle(),
              std::numbers::pi / 2, 1e-14);
  for (const double side : {-1.0, 1.0})
    EXPECT_NEAR(SeenFace(square(), {0, 0, side}).solid_angle(), 4 * std::numbers::pi / 6, 1e-14);
  // Nearly all of the hemisphere, and nothing.
  EXPECT_NEAR(SeenFace(square(), {0, 0, 1e-9}).solid_angle(), 2 * std::numbers::pi, 1e-5);
  EXPECT_NEAR(SeenFace(square(), {3, 0, 0}).solid_angle(), 0, 1e-12);
}

// As many draws fall into a part of the face as it has of the solid angle.
TEST(SeenFace, DrawsDirectionsEvenly) {
  std::mt19937 random(1);
  constexpr int kDraws = 100000;
  for (const glm::dvec3& from : {glm::dvec3(0, 0, 0.1), glm::dvec3(0.9, 0.2, 0.02), glm::dvec3(2, -3, 4)}) {
    const SeenFace whole(square(), from);
    // The four quarters around a point that is not the middle.
    const glm::dvec3 middle(0.6, 0.1, 0);
    std::array<int, 4> drawn{};
    for (int k = 0; k < kDraws; ++k) {
      const glm::dvec3 x = whole.draw(test_scenes::uniform(random, 0, 1), test_scenes::uniform(random, 0, 1));
      EXPECT_NEAR(x.z, 0, 1e-9);
      ASSERT_LE(std::max(std::abs(x.x), std::abs(x.y)), 1 + 1e-9);
      ++drawn[(x.x > middle.x ? 1 : 0) + (x.y > middle.y ? 2 : 0)];
    }
    for (std::size_t part = 0; part < drawn.size(); ++part) {
      Outline<glm::dvec3> quarter = square();
      for (glm::dvec3& corner : quarter.corner) {
        corner.x = part % 2 == 1 ? std::max(corner.x, middle.x) : std::min(corner.x, middle.x);
        corner.y = part / 2 == 1 ? std::max(corner.y, middle.y) : std::min(corner.y, middle.y);
      }
      const double expected = kDraws * SeenFace(quarter, from).solid_angle() / whole.solid_angle();
      EXPECT_NEAR(drawn[part], expected, 5 * std::sqrt(expected)) << part;
    }
  }
}

}  // namespace
}  // namespace fluxel
