#include "visibility/segment_lanes.hpp"

#include <gtest/gtest.h>

#include <array>

#include "tests/unit/test_scenes.hpp"
#include "visibility/segment_test.hpp"

namespace fluxel {
namespace {

struct Lanes {
  std::array<std::array<float, 16>, 6> coordinate{};

  [[nodiscard]] SegmentLanes view(unsigned count) const {
    const auto& c = coordinate;
    return {c[0].data(), c[1].data(), c[2].data(), c[3].data(), c[4].data(), c[5].data(), count};
  }
  [[nodiscard]] bool meets(const Patch& patch, std::size_t k) const {
    const glm::dvec3 from(coordinate[0][k], coordinate[1][k], coordinate[2][k]);
    const glm::dvec3 along(coordinate[3][k], coordinate[4][k], coordinate[5][k]);
    return segment_meets(patch, from, from + along);
  }
};

/// Patches and segments with coordinates on a lattice of this many steps, so that lines pass through edges,
/// corners and planes; by chance where it is 0.
void expect_same(int steps, unsigned count, std::mt19937& random) {
  const auto coordinate = [&] {
    return steps == 0 ? test_scenes::uniform(random, -1, 1)
                      : static_cast<double>(random() % static_cast<unsigned>(2 * steps + 1)) / steps - 1;
  };
  const auto point = [&] {
    const double x = coordinate(), y = coordinate();
    return glm::dvec3(x, y, coordinate());
  };
  std::size_t met = 0, asked_of = 0;
  for (int repeat = 0; repeat < 3000; ++repeat) {
    const glm::dvec3 a = point(), b = point(), c = point();
    if (glm::length(glm::cross(b - a, c - a)) < 1e-6) continue;
    Scene scene = by_hand::empty_scene(Sides::two);
    if (repeat % 2 == 0) {
      by_hand::add(scene, "triangle", {a, b, c});
    } else {
      by_hand::add(scene, "parallelogram", {a, b, b + c - a, c});
    }
    const Patch& patch = scene.patches.front();
    Lanes lanes;
    for (auto& values : lanes.coordinate)
      for (float& value : values) value = static_cast<float>(coordinate());
    const std::uint32_t asked = static_cast<std::uint32_t>(random()) & ((1u << count) - 1);
    std::uint32_t expected = 0;
    for (unsigned k = 0; k < count; ++k)
      if ((asked >> k & 1u) != 0 && lanes.meets(patch, k)) expected |= 1u << k;
    ASSERT_EQ(segments_meet(patch, lanes.view(count), asked), expected);
    met += static_cast<std::size_t>(std::popcount(expected));
    asked_of += static_cast<std::size_t>(std::popcount(asked));
  }
  EXPECT_GT(met, asked_of / 100);
  EXPECT_LT(met, asked_of / 2);
}

TEST(SegmentLanes, SayWhatTheSegmentTestSays) {
  std::mt19937 random(21);
  for (const int steps : {0, 1, 2, 5})
    for (const unsigned count : {1u, 4u, 8u, 16u}) expect_same(steps, count, random);
}

}  // namespace
}  // namespace fluxel
