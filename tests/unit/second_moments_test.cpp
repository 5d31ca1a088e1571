#include "core/second_moments.hpp"

#include <gtest/gtest.h>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using test_scenes::uniform;

Outline<glm::dvec3> triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  return {{a, b, c, {}}, 3};
}

Outline<glm::dvec3> parallelogram(const glm::dvec3& a, const glm::dvec3& u, const glm::dvec3& v) {
  return {{a, a + u, a + u + v, a + v}, 4};
}

glm::dmat3 covariance(const std::vector<glm::dvec3>& points) {
  glm::dvec3 mean(0);
  for (const glm::dvec3& x : points) mean += x / static_cast<double>(points.size());
  glm::dmat3 sum(0);
  for (const glm::dvec3& x : points)
    sum += glm::outerProduct(x - mean, x - mean) / static_cast<double>(points.size());
  return sum;
}

/// By quadrature rules that are exact to second degree: the middles of a triangle's edges, the four Gauss
/// points of a parallelogram.
glm::dmat3 exact_covariance(const Outline<glm::dvec3>& outline) {
  const auto& c = outline.corner;
  if (outline.corners == 3)
    return covariance({(c[0] + c[1]) / 2.0, (c[1] + c[2]) / 2.0, (c[2] + c[0]) / 2.0});
  std::vector<glm::dvec3> points;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-1.0, 1.0})
      points.push_back(c[0] + (0.5 + a / std::sqrt(12.0)) * (c[1] - c[0]) +
                       (0.5 + b / std::sqrt(12.0)) * (c[3] - c[0]));
  return covariance(points);
}

/// What the moments say, as a matrix.
glm::dmat3 tensor(const SecondMoments& moments, const glm::dvec3& normal) {
  return moments.minor_variance * (glm::dmat3(1) - glm::outerProduct(normal, normal)) +
         glm::outerProduct(moments.elongation, moments.elongation);
}

double largest_difference(const glm::dmat3& a, const glm::dmat3& b) {
  double largest = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) largest = std::max(largest, std::abs(a[i][j] - b[i][j]));
  return largest;
}

void expect_exact(const Outline<glm::dvec3>& outline) {
  const SecondMoments moments = second_moments(outline);
  const glm::dmat3 exact = exact_covariance(outline);
  const double trace = exact[0][0] + exact[1][1] + exact[2][2];
  const glm::dvec3 normal = glm::normalize(area_vector(corners(outline)));
  EXPECT_LT(largest_difference(tensor(moments, normal), exact), 1e-14 * trace);
  EXPECT_NEAR(moments.trace(), trace, 1e-14 * trace);
  EXPECT_GE(moments.minor_variance, 0);
  EXPECT_NEAR(glm::dot(moments.elongation, normal), 0, 1e-15 * std::sqrt(trace)) << "it lies in the plane";
}

TEST(SecondMoments, KnownShapes) {
  const SecondMoments square = second_moments(parallelogram({5, 6, 7}, {2, 0, 0}, {0, 2, 0}));
  EXPECT_DOUBLE_EQ(square.minor_variance, 4.0 / 12);
  EXPECT_EQ(square.elongation, glm::dvec3(0));
  EXPECT_DOUBLE_EQ(square.trace(), 8.0 / 12);

  for (const bool along_first : {true, false}) {
    const glm::dvec3 u(along_first ? 3 : 1, 0, 0), v(0, along_first ? 1 : 3, 0);
    const SecondMoments rectangle = second_moments(parallelogram({0, 0, 0}, u, v));
    EXPECT_DOUBLE_EQ(rectangle.minor_variance, 1.0 / 12);
    EXPECT_NEAR(glm::dot(rectangle.elongation, rectangle.elongation), 8.0 / 12, 1e-15);
    EXPECT_NEAR(std::abs(rectangle.elongation[along_first ? 0 : 1]), std::sqrt(8.0 / 12), 1e-15);
  }

  // Equilateral of side 1: the trace is (sum of squared sides) / 36, the same along every axis.
  const SecondMoments equilateral = second_moments(triangle({0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}));
  EXPECT_NEAR(equilateral.minor_variance, 1.0 / 24, 1e-16);
  EXPECT_NEAR(equilateral.trace(), 1.0 / 12, 1e-15);
}

TEST(SecondMoments, RandomShapesAreExact) {
  std::mt19937 random(1);
  for (int k = 0; k < 5000; ++k) {
    const glm::dvec3 a = test_scenes::uniform_point(random, -1, 1);
    const glm::dvec3 u = std::exp(uniform(random, -7, 7)) * test_scenes::random_direction(random);
    const glm::dvec3 v = glm::length(u) * uniform(random, 0.1, 3) * test_scenes::random_direction(random);
    expect_exact(parallelogram(glm::length(u) * a, u, v));
    expect_exact(triangle(glm::length(u) * a, glm::length(u) * a + u, glm::length(u) * a + v));
  }
}

// The axes of a sliver do not follow its edges; of the shorter one only the absolute error can be asked.
TEST(SecondMoments, SliversOfAnyDirection) {
  std::mt19937 random(2);
  for (const double aspect : {1e2, 1e4, 1e6}) {
    for (int k = 0; k < 200; ++k) {
      const glm::dquat turn = by_hand::random_rotation(random);
      const glm::dvec3 u = turn * glm::dvec3(1, 0, 0);
      const glm::dvec3 v = turn * glm::dvec3(uniform(random, -1, 2), 1 / aspect, 0);
      const glm::dvec3 normal = turn * glm::dvec3(0, 0, 1);
      for (const auto& outline :
           {triangle(glm::dvec3(0), u, v), triangle(u, v, glm::dvec3(0)), triangle(v, glm::dvec3(0), u),
            parallelogram(glm::dvec3(0), u, v), parallelogram(glm::dvec3(0), v, u)}) {
        const glm::dmat3 exact = exact_covariance(outline);
        const double trace = exact[0][0] + exact[1][1] + exact[2][2];
        const SecondMoments moments = second_moments(outline);
        ASSERT_LT(largest_difference(tensor(moments, normal), exact), 1e-14 * trace);
        ASSERT_LT(moments.minor_variance, 1e-14 * trace + 1 / (aspect * aspect));
      }
    }
  }
}

TEST(SecondMoments, DegenerateShapesStayFinite) {
  const glm::dvec3 a(1, 2, 3), u(1, 0, 0);
  for (const auto& outline :
       {triangle(a, a, a), parallelogram(a, {0, 0, 0}, {0, 0, 0}), triangle(a, a + u, a + 2.0 * u),
        triangle(a, a + u, a), parallelogram(a, u, 3.0 * u), parallelogram(a, u, {0, 0, 0})}) {
    const SecondMoments moments = second_moments(outline);
    const glm::dmat3 exact = exact_covariance(outline);
    EXPECT_NEAR(moments.minor_variance, 0, 1e-16);
    EXPECT_NEAR(moments.trace(), exact[0][0] + exact[1][1] + exact[2][2], 1e-15);
  }
}

// Uniform points in the shape itself know no formula at all.
TEST(SecondMoments, AgreeWithRandomPoints) {
  std::mt19937 random(3);
  const glm::dvec3 u(2, 1, 0.5), v(-0.4, 0.3, 1);
  const auto [whole, half] = std::pair{parallelogram({}, u, v), triangle({}, u, v)};
  for (const auto& outline : {whole, half}) {
    std::vector<glm::dvec3> points;
    while (points.size() < 200'000) {
      const double s = uniform(random, 0, 1), t = uniform(random, 0, 1);
      if (outline.corners == 4 || s + t < 1) points.push_back(s * u + t * v);
    }
    const glm::dvec3 normal = glm::normalize(glm::cross(u, v));
    const SecondMoments moments = second_moments(outline);
    // Five standard errors of a variance of 2e5 points.
    EXPECT_LT(largest_difference(tensor(moments, normal), covariance(points)), 0.01 * moments.trace());
  }
}

TEST(SecondMoments, WidenKeepsEveryCorner) {
  const Outline<glm::vec3> outline{{glm::vec3{0.1f, 2, 3}, {4, 5, 6}, {7, 8, 9.3f}, {}}, 3};
  const Outline<glm::dvec3> wide = widen(outline);
  ASSERT_EQ(wide.corners, 3u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(wide.corner[k], glm::dvec3(outline.corner[k]));
}

}  // namespace
}  // namespace fluxel
