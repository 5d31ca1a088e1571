#include "subdivision/bisection.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using test_scenes::kUnbounded;
using test_scenes::uniform;

/// Sides between 1 and `aspect` apart in length, any angle between them.
Outline3 random_parallelogram(std::mt19937& random, double aspect) {
  const glm::dquat rotation = by_hand::random_rotation(random);
  const double angle = uniform(random, 0.01, 3.13);
  const glm::dvec3 a = test_scenes::uniform_point(random, -1, 1);
  const glm::dvec3 u = rotation * glm::dvec3(std::exp(uniform(random, 0, std::log(aspect))), 0, 0);
  const glm::dvec3 v = rotation * glm::dvec3(std::cos(angle), std::sin(angle), 0);
  if (uniform(random, 0, 1) < 0.5) return {{a, a + u, a + u + v, a + v}, 4};
  return {{a, a + v, a + u + v, a + u}, 4};
}

/// From well-shaped triangles to needles of height `thin`.
Outline3 random_triangle(std::mt19937& random, double thin) {
  const glm::dquat rotation = by_hand::random_rotation(random);
  const double height = std::exp(uniform(random, std::log(thin), 0));
  const glm::dvec3 a = test_scenes::uniform_point(random, -1, 1);
  Outline3 triangle{{a, a + rotation * glm::dvec3(1, 0, 0),
                     a + rotation * glm::dvec3(uniform(random, -0.2, 1.2), height, 0)},
                    3};
  const auto turned = static_cast<std::ptrdiff_t>(random() % 3);
  std::rotate(triangle.corner.begin(), triangle.corner.begin() + turned, triangle.corner.begin() + 3);
  return triangle;
}

Outline3 random_half(const Outline3& outline, std::mt19937& random) {
  const auto [left, right] = bisect(outline);
  return random() % 2 == 0 ? left : right;
}

glm::dvec3 random_point_in(const Outline3& outline, std::mt19937& random) {
  double u = uniform(random, 0, 1), v = uniform(random, 0, 1);
  if (outline.corners == 3 && u + v > 1) u = 1 - u, v = 1 - v;
  const glm::dvec3 corner = outline.corner[0];
  return corner + u * (outline.corner[1] - corner) + v * (outline.corner[outline.corners - 1] - corner);
}

glm::dvec3 normal_of(const Outline3& outline) {
  return glm::normalize(
      glm::cross(outline.corner[1] - outline.corner[0], outline.corner[2] - outline.corner[0]));
}

TEST(Bisection, ASquareIsCutAcrossItsFirstSideAndARectangleAcrossItsLongSides) {
  const Outline3 square{{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, 4};
  const auto [left, right] = bisect(square);
  EXPECT_EQ(left.corner, (std::array<glm::dvec3, 4>{{{0, 0, 0}, {0.5, 0, 0}, {0.5, 1, 0}, {0, 1, 0}}}));
  EXPECT_EQ(right.corner, (std::array<glm::dvec3, 4>{{{0.5, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.5, 1, 0}}}));
  const Outline3 high{{{{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 2, 0}}}, 4};
  EXPECT_EQ(longest_edge(bisect(high).first), 1);
  EXPECT_EQ(longest_edge(bisect(high).second), 1);
}

TEST(Bisection, ATriangleIsCutByTheMedianToItsLongestSide) {
  const Outline3 triangle{{{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}}}, 3};
  const auto [left, right] = bisect(triangle);
  const glm::dvec3 middle(0.5, 1, 0);
  for (const Outline3& half : {left, right}) {
    EXPECT_EQ(half.corners, 3u);
    EXPECT_EQ(std::count(half.corner.begin(), half.corner.begin() + 3, middle), 1);
    EXPECT_EQ(std::count(half.corner.begin(), half.corner.begin() + 3, glm::dvec3(0)), 1);
  }
}

TEST(Bisection, HalvesHaveEqualAreaAndKeepPlaneAndOrientation) {
  std::mt19937 random(1);
  for (int k = 0; k < 2000; ++k) {
    const Outline3 root = k % 2 == 0 ? random_parallelogram(random, 20) : random_triangle(random, 1e-2);
    const auto [left, right] = bisect(root);
    EXPECT_NEAR(area(left), 0.5 * area(root), 1e-13 * diameter(root) * diameter(root));
    EXPECT_NEAR(area(right), 0.5 * area(root), 1e-13 * diameter(root) * diameter(root));
    EXPECT_GT(glm::dot(normal_of(left), normal_of(root)), 1 - 1e-9);
    EXPECT_GT(glm::dot(normal_of(right), normal_of(root)), 1 - 1e-9);
    EXPECT_EQ(left.corners, root.corners);
  }
}

TEST(Bisection, AreasOfLeavesAddUpToTheRoots) {
  std::mt19937 random(2);
  for (int k = 0; k < 40; ++k) {
    const Outline3 root = k % 2 == 0 ? random_parallelogram(random, 5) : random_triangle(random, 0.1);
    std::vector<PixelPoint> pixels;
    for (std::size_t p = 0; p < 300; ++p) pixels.push_back({p, random_point_in(root, random)});
    std::vector<Leaf> leaves;
    bisect_until(root, pixels, 1, 0.2, leaves);
    double sum = 0;
    std::vector<std::size_t> owned;
    for (const Leaf& leaf : leaves) {
      sum += area(leaf.outline);
      EXPECT_LE(longest_edge(leaf.outline), 0.2);
      EXPECT_LE(leaf.pixels.size(), 1u);
      EXPECT_NEAR(area(leaf.outline), std::ldexp(area(root), -leaf.depth), 1e-14);
      owned.insert(owned.end(), leaf.pixels.begin(), leaf.pixels.end());
    }
    EXPECT_NEAR(sum, area(root), 1e-12 * area(root));
    std::ranges::sort(owned);
    ASSERT_EQ(owned.size(), 300u) << "each pixel belongs to one leaf";
    for (std::size_t p = 0; p < 300; ++p) EXPECT_EQ(owned[p], p);
  }
}

TEST(Bisection, APixelsPointLiesInItsLeaf) {
  std::mt19937 random(3);
  for (int k = 0; k < 40; ++k) {
    const Outline3 root = k % 2 == 0 ? random_parallelogram(random, 5) : random_triangle(random, 0.1);
    std::vector<PixelPoint> pixels;
    for (std::size_t p = 0; p < 100; ++p) pixels.push_back({p, random_point_in(root, random)});
    std::vector<Leaf> leaves;
    bisect_until(root, pixels, 1, kUnbounded, leaves);
    for (const Leaf& leaf : leaves) {
      for (const std::size_t p : leaf.pixels) {
        for (std::uint32_t c = 0; c < leaf.outline.corners; ++c) {
          const glm::dvec3 from = leaf.outline.corner[c];
          const glm::dvec3 along = leaf.outline.corner[(c + 1) % leaf.outline.corners] - from;
          const double inside = glm::dot(glm::cross(normal_of(root), along), pixels[p].point - from);
          EXPECT_GT(inside, -1e-12);
        }
      }
    }
  }
}

TEST(Bisection, AParallelogramsDiameterFallsByTheRootOfFiveEighthsAStep) {
  std::mt19937 random(4);
  const double shrink = std::sqrt(5.0 / 8.0);
  double worst = 0;
  for (int k = 0; k < 5000; ++k) {
    Outline3 node = random_parallelogram(random, 100);
    for (int step = 0; step < 6; ++step) {
      const Outline3 half = random_half(node, random);
      worst = std::max(worst, diameter(half) / diameter(node));
      node = half;
    }
  }
  EXPECT_LE(worst, shrink + 1e-12);
  const Outline3 square{{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, 4};
  EXPECT_NEAR(diameter(bisect(square).first) / diameter(square), shrink, 1e-15) << "squares attain it";
}

TEST(Bisection, ATrianglesDiameterFallsByHalfTheRootOfThreeInTwoSteps) {
  std::mt19937 random(5);
  double worst = 0;
  for (int k = 0; k < 5000; ++k) {
    Outline3 node = random_triangle(random, 1e-4);
    for (int pair = 0; pair < 4; ++pair) {
      const auto [left, right] = bisect(node);
      for (const Outline3& half : {left, right}) {
        const auto [first, second] = bisect(half);
        worst = std::max({worst, diameter(first) / diameter(node), diameter(second) / diameter(node)});
      }
      node = random_half(random_half(node, random), random);
    }
  }
  EXPECT_LE(worst, std::sqrt(0.75) + 1e-12);
  EXPECT_GT(worst, 0.8) << "the sample has triangles for which two steps do little";
  const Outline3 needle{{{{0, 0, 0}, {1, 0, 0}, {1, 0.001, 0}}}, 3};
  EXPECT_GT(diameter(bisect(needle).first) + diameter(bisect(needle).second), diameter(needle));
}

TEST(Bisection, TheStepBoundBringsEveryNodeBelowTheSpacing) {
  std::mt19937 random(6);
  for (int k = 0; k < 4000; ++k) {
    Outline3 node = k % 2 == 0 ? random_parallelogram(random, 50) : random_triangle(random, 1e-4);
    const double spacing = diameter(node) * std::exp(uniform(random, std::log(1e-3), 0.1));
    const int bound = step_bound(node, spacing);
    ASSERT_GE(bound, 0);
    for (int step = 0; step < bound; ++step) node = random_half(node, random);
    ASSERT_LT(diameter(node), spacing);
  }
}

TEST(Bisection, PointsASpacingApartArePartedWithinTheBound) {
  std::mt19937 random(7);
  int deepest = 0;
  for (int k = 0; k < 300; ++k) {
    const Outline3 root = k % 2 == 0 ? random_parallelogram(random, 10) : random_triangle(random, 1e-2);
    const double spacing = diameter(root) * std::exp(uniform(random, std::log(0.005), std::log(0.3)));
    std::vector<PixelPoint> pixels;
    for (int dart = 0; dart < 300; ++dart) {
      glm::dvec3 point = random_point_in(root, random);
      // Half of the darts go as close to another as they may: between it and a point of the root.
      if (dart % 2 == 1 && glm::distance(point, pixels.back().point) > 1.1 * spacing)
        point = pixels.back().point + 1.0001 * spacing * glm::normalize(point - pixels.back().point);
      if (std::ranges::all_of(
              pixels, [&](const PixelPoint& other) { return glm::distance(other.point, point) >= spacing; }))
        pixels.push_back({pixels.size(), point});
    }
    std::vector<Leaf> leaves;
    bisect_until(root, pixels, 1, kUnbounded, leaves);
    for (const Leaf& leaf : leaves) {
      ASSERT_LE(leaf.depth, step_bound(root, spacing));
      deepest = std::max(deepest, leaf.depth);
    }
  }
  EXPECT_GT(deepest, 10);
}

TEST(Bisection, NoStepsWhereTheRootIsSmallEnough) {
  const Outline3 square{{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, 4};
  EXPECT_EQ(step_bound(square, 1.5), 0);
  EXPECT_EQ(step_bound(square, 1.4), 1);
  EXPECT_GT(step_bound(square, std::sqrt(2.0)), 0)
      << "a diameter equal to the spacing does not part two points";
}

TEST(Bisection, PointsThatCannotBeToldApartAreAnError) {
  const Outline3 square{{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, 4};
  std::vector<Leaf> leaves;
  EXPECT_THROW(bisect_until(square, {{0, {0.3, 0.3, 0}}, {1, {0.3, 0.3, 0}}}, 1, kUnbounded, leaves),
               InputError);
}

// Elements are kept in single precision, whose numbers are 2^-22 apart from 2 to 4: of points nearer to each
// other the elements' corners would coincide.
TEST(Bisection, PointsNearerThanSinglePrecisionAreAnError) {
  const Outline3 square{{{{3, 3, 0}, {4, 3, 0}, {4, 4, 0}, {3, 4, 0}}}, 4};
  std::vector<Leaf> leaves;
  const auto part = [&](double apart) {
    bisect_until(square, {{0, {3.3, 3.3, 0}}, {1, {3.3 + apart, 3.3, 0}}}, 1, kUnbounded, leaves);
  };
  EXPECT_THROW(part(1e-9), InputError);
  EXPECT_NO_THROW(part(1e-6));
}

}  // namespace
}  // namespace fluxel
