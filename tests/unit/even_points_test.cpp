#include "formfactor/even_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/sampling.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using Point = std::array<double, SobolPoints::kAxes>;

std::vector<Point> first_points(std::uint64_t seed, std::size_t count) {
  SobolPoints points(seed);
  std::vector<Point> made(count);
  std::ranges::generate(made, [&points] { return points.next(); });
  return made;
}

std::size_t cell(double x, std::size_t cells) {
  return static_cast<std::size_t>(x * static_cast<double>(cells));
}

TEST(SobolPoints, EachOfAPowerOfTwoIsInAStratumOfItsOwn) {
  for (const std::uint64_t seed : {0ull, 1ull, 0xFFFFFFFFFFFFFFFFull}) {
    const std::vector<Point> points = first_points(seed, 4096);
    for (const Point& point : points)
      for (const double x : point) ASSERT_TRUE(x > 0 && x < 1);
    for (std::size_t count = 1; count <= points.size(); count *= 2) {
      for (std::size_t axis = 0; axis < SobolPoints::kAxes; ++axis) {
        // The first `count`, and the last, which are a power of two of points in a row as well.
        for (const std::size_t start : {std::size_t{0}, points.size() - count}) {
          std::set<std::size_t> strata;
          for (std::size_t k = 0; k < count; ++k) strata.insert(cell(points[start + k][axis], count));
          ASSERT_EQ(strata.size(), count) << "axis " << axis;
        }
      }
    }
  }
}

// Of the first two axes every box of 2^-a x 2^-b holds one of 2^(a + b) points.
TEST(SobolPoints, TheFirstTwoAxesFillEveryBox) {
  const std::vector<Point> points = first_points(7, 256);
  for (std::size_t wide = 1; wide <= 256; wide *= 2) {
    std::set<std::pair<std::size_t, std::size_t>> boxes;
    for (const Point& point : points) boxes.emplace(cell(point[0], wide), cell(point[1], 256 / wide));
    EXPECT_EQ(boxes.size(), 256u) << wide;
  }
}

TEST(SobolPoints, SeedsDifferInEveryAxis) {
  std::array<std::set<double>, SobolPoints::kAxes> seen;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const Point point = SobolPoints(seed).next();
    EXPECT_EQ(point, SobolPoints(seed).next());
    for (std::size_t axis = 0; axis < seen.size(); ++axis) seen[axis].insert(point[axis]);
  }
  for (const std::set<double>& of_axis : seen) {
    EXPECT_GE(of_axis.size(), 999u) << "of 2^32";
    double mean = 0;
    for (const double x : of_axis) mean += x / static_cast<double>(of_axis.size());
    EXPECT_NEAR(mean, 0.5, 4 / std::sqrt(12.0 * 1000)) << "and are spread evenly";
  }
}

TEST(SobolPoints, StartAgainAfterTheirLength) {
  const std::vector<Point> points = first_points(3, SobolPoints::kLength + 2);
  EXPECT_EQ(points[SobolPoints::kLength], points[0]);
  EXPECT_EQ(points[SobolPoints::kLength + 1], points[1]);
  EXPECT_NE(points[SobolPoints::kLength - 1], points[0]);
}

/// Convex; the second one has a corner in the middle of an edge and the last one two corners in one place.
const std::vector<SmallPolygon> kPolygons{{{0, 0, 1}, {2, 0, 1}, {0, 1, 1}},
                                          {{0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {0, 1, 1}},
                                          {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}},
                                          {{0, 0, 0}, {1, -1, 0}, {3, 0, 0}, {2, 2, 0}, {0.5, 1.5, 0}},
                                          {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}, {0, 0, 0}}};

TEST(PolygonFan, PreservesArea) {
  std::mt19937 random(1);
  constexpr int kGrid = 300;
  for (const SmallPolygon& polygon : kPolygons) {
    const PolygonFan fan(polygon);
    for (int repeat = 0; repeat < 10; ++repeat) {
      const double angle = test_scenes::uniform(random, 0, 7);
      const Plane half{centroid(corners(polygon)) + 0.3 * test_scenes::uniform_point(random, -1, 1),
                       {std::cos(angle), std::sin(angle), 0}};
      const SmallPolygon front = clip_to_front(corners(polygon), half);
      int found = 0;
      for (int i = 0; i < kGrid; ++i)
        for (int j = 0; j < kGrid; ++j)
          found += half.distance(fan.point((i + 0.5) / kGrid, (j + 0.5) / kGrid)) > 0 ? 1 : 0;
      // A line through the grid leaves a doubt of about one cell along its length.
      EXPECT_NEAR(found / static_cast<double>(kGrid * kGrid), area(corners(front)) / area(corners(polygon)),
                  3.0 / kGrid);
    }
  }
}

TEST(PolygonFan, StaysInside) {
  for (const SmallPolygon& polygon : kPolygons) {
    const PolygonFan fan(polygon);
    const glm::dvec3 normal = glm::normalize(area_vector(corners(polygon)));
    for (const double u : {0.0, 1e-300, 0.25, 0.5, 0.999, 1 - 0x1p-33}) {
      for (const double v : {0.0, 0.3, 1 - 0x1p-33}) {
        const glm::dvec3 x = fan.point(u, v);
        for (std::size_t edge = 0; edge < polygon.size(); ++edge) {
          const glm::dvec3 along = polygon[(edge + 1) % polygon.size()] - polygon[edge];
          ASSERT_GE(glm::dot(glm::cross(along, x - polygon[edge]), normal), -1e-15) << u << ' ' << v;
        }
        ASSERT_EQ(x.z, polygon[0].z);
      }
    }
  }
}

TEST(RandomBits, EveryBitIsSetHalfTheTime) {
  std::array<int, 64> set{};
  for (std::uint64_t seed = 0; seed < 4096; ++seed)
    for (std::size_t bit = 0; bit < 64; ++bit) set[bit] += static_cast<int>(random_bits(seed) >> bit & 1u);
  for (const int count : set) EXPECT_NEAR(count, 2048, 5 * 32);
}

// As of a needle, whose corners coincide once they are rounded to single precision.
TEST(PolygonFan, PointsOfAFlattenedPolygonLieOnIt) {
  for (const SmallPolygon& flat : {SmallPolygon{{1, 2, 3}, {5, 2, 3}, {5, 2, 3}},
                                   SmallPolygon{{1, 2, 3}, {3, 2, 3}, {5, 2, 3}, {3, 2, 3}},
                                   SmallPolygon{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}}}) {
    const PolygonFan fan(flat);
    SobolPoints places(1);
    for (int k = 0; k < 64; ++k) {
      const auto [u, v, s, t] = places.next();
      const glm::dvec3 point = fan.point(u, v);
      ASSERT_TRUE(point.x >= 1 && point.x <= 5) << point.x;
      ASSERT_EQ(point.y, 2);
      ASSERT_EQ(point.z, 3);
    }
  }
}

}  // namespace
}  // namespace fluxel
