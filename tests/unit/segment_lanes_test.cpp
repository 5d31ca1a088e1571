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

/// Where a line crosses a triangle's plane, as a ray tracer says it: off by up to 20 units of the extent,
/// over the sine of the angle.
std::array<float, 2> crossing(const std::array<glm::dvec3, 3>& corner, const glm::dvec3& from,
                              const glm::dvec3& along, std::mt19937& random) {
  const glm::dvec3 a = corner[1] - corner[0], b = corner[2] - corner[0], n = glm::cross(a, b);
  const double slope = glm::dot(n, along) / (glm::length(n) * glm::length(along));
  const double error = 20 * 2 * 0x1p-24 / std::abs(slope);
  const glm::dvec3 at = from - along * (glm::dot(n, from - corner[0]) / glm::dot(n, along)) +
                        error * glm::normalize(test_scenes::uniform_point(random, -1, 1)) - corner[0];
  return {static_cast<float>(glm::dot(glm::cross(at, b), n) / glm::dot(n, n)),
          static_cast<float>(glm::dot(glm::cross(a, at), n) / glm::dot(n, n))};
}

TEST(SegmentLanes, WhatIsSureIsSo) {
  std::mt19937 random(22);
  const auto uniform = [&] { return test_scenes::uniform(random, -1, 1); };
  const std::array ends{1.0, 1.0, 1.0, 1e-8, -0.3};
  std::size_t sure = 0, met = 0;
  for (int repeat = 0; repeat < 20000; ++repeat) {
    const glm::dvec3 a = test_scenes::uniform_point(random, -1, 1),
                     b = test_scenes::uniform_point(random, -1, 1);
    // Down to slivers.
    const glm::dvec3 c =
        glm::mix(a, b, 0.5) + std::pow(10, 2 * uniform() - 2) * test_scenes::uniform_point(random, -1, 1);
    if (glm::length(glm::cross(b - a, c - a)) < 1e-9) continue;
    Scene scene = by_hand::empty_scene(Sides::two);
    by_hand::add(scene, "triangle", {a, b, c});
    const Patch& patch = scene.patches.front();
    const Outline<glm::dvec3> outline = enlarged(patch, 2);
    const std::array corner{outline.corner[0], outline.corner[1], outline.corner[2]};
    Lanes lanes;
    std::array<float, 16> u{}, v{};
    for (std::size_t k = 0; k < 16; ++k) {
      // Through points of the triangle, some by an edge; some along its plane; some end by it or before it,
      // some begin far away.
      const double s = random() % 3 != 0 ? 0.5 + 0.6 * uniform() : 1e-5 * uniform(),
                   t = (1 - s) * (0.5 + 0.6 * uniform());
      const glm::dvec3 at = a + s * (b - a) + t * (c - a);
      const glm::dvec3 off =
          random() % 3 != 0 ? test_scenes::uniform_point(random, -1, 1)
                            : uniform() * (b - a) + uniform() * (c - a) + 1e-4 * uniform() * patch.normal;
      const double far = random() % 4 == 0 ? 60 : 1;
      const glm::dvec3 from = at + far * off, to = at - ends[random() % 5] * off;
      for (int axis = 0; axis < 3; ++axis) {
        lanes.coordinate[static_cast<std::size_t>(axis)][k] = static_cast<float>(from[axis]);
        lanes.coordinate[static_cast<std::size_t>(axis) + 3][k] = static_cast<float>((to - from)[axis]);
      }
      const std::array<float, 2> place = crossing(corner, from, to - from, random);
      u[k] = place[0], v[k] = place[1];
    }
    const TriangleCore core(patch, corner, 2);
    const std::uint32_t said = segments_surely_meet(core, lanes.view(16), {u.data(), v.data()}, 0xFFFF);
    const std::uint32_t truth = segments_meet(patch, lanes.view(16), 0xFFFF);
    ASSERT_EQ(said & ~truth, 0U) << repeat;
    ASSERT_EQ(segments_surely_meet(core, lanes.view(16), {u.data(), v.data()}, 0x0F0F), said & 0x0F0F);
    sure += static_cast<std::size_t>(std::popcount(said));
    met += static_cast<std::size_t>(std::popcount(truth));
  }
  EXPECT_GT(sure, met / 10);
}

}  // namespace
}  // namespace fluxel
