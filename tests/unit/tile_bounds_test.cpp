#include "formfactor/tile_bounds.hpp"

#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "core/second_moments.hpp"
#include "tests/closed_forms/closed_forms.hpp"
#include "tests/unit/test_scenes.hpp"
#include "visibility/tile.hpp"

namespace fluxel {
namespace {

using test_scenes::uniform;

/// A rectangle or triangle about a centroid, turned at random.
Element random_element(const glm::dvec3& about, double size, std::mt19937& random,
                       closed_forms::Polygon* polygon = nullptr) {
  const glm::dquat turn = by_hand::random_rotation(random);
  const double height = size * uniform(random, 0.2, 1);
  std::vector<glm::dvec3> shape{{0, 0, 0}, {size, 0, 0}, {size, height, 0}};
  if (random() % 3 != 0) shape.emplace_back(0, height, 0);
  const glm::dvec3 middle = centroid(shape);
  Outline<glm::dvec3> outline;
  outline.corners = static_cast<std::uint32_t>(shape.size());
  for (std::size_t c = 0; c < shape.size(); ++c)
    outline.corner[c] = shape[c] = about + turn * (shape[c] - middle);
  const SecondMoments moments = second_moments(outline);
  Element made;
  made.centroid = glm::vec3(about);
  made.normal = glm::vec3(turn * glm::dvec3(0, 0, 1));
  made.area = static_cast<float>(area(shape));
  made.sides = kFront;
  made.minor_variance = static_cast<float>(moments.minor_variance);
  made.elongation = glm::vec3(moments.elongation);
  if (polygon != nullptr) *polygon = shape;
  return made;
}

/// A full tile and one that is not, some way apart; sizes differ from tile to tile.
struct TwoTiles {
  static constexpr std::size_t kFirst = kTileSize, kAll = kTileSize + 20;
  std::vector<Element> elements;
  TileShape a, b;

  explicit TwoTiles(std::mt19937& random) {
    const glm::dvec3 apart = std::exp(uniform(random, -1, 4)) * test_scenes::random_direction(random);
    const double width = uniform(random, 0.1, 2), size = std::exp(uniform(random, -3, 0.5));
    for (std::size_t k = 0; k < kAll; ++k) {
      const glm::dvec3 about = test_scenes::uniform_point(random, -width, width);
      elements.push_back(
          random_element(k < kFirst ? about : about + apart, size * uniform(random, 0.3, 1), random));
    }
    a = tile_shape(elements, 0);
    b = tile_shape(elements, 1);
  }

  /// visit(i, j) for every pair of both tiles.
  template <class Visit>
  void each_pair(Visit visit) const {
    for (std::size_t i = 0; i < kFirst; ++i)
      for (std::size_t j = kFirst; j < kAll; ++j) visit(i, j);
  }
};

// The gap of two boxes is single precision.
constexpr double kRounding = 1 + 1e-6;

TEST(TileBounds, ATileIsAsLargeAsItsLargest) {
  std::mt19937 random(1);
  const TwoTiles tiles(random);
  for (std::size_t k = 0; k < TwoTiles::kAll; ++k) {
    const Element& element = tiles.elements[k];
    const TileShape& shape = k < TwoTiles::kFirst ? tiles.a : tiles.b;
    EXPECT_LE(element.area, shape.area);
    EXPECT_LE(flat_shape(element).moments.trace(), shape.variance);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(shape.low[axis], element.centroid[axis]);
      EXPECT_GE(shape.high[axis], element.centroid[axis]);
    }
  }
}

TEST(TileBounds, NearPairsAreNeverOverlooked) {
  std::mt19937 random(2);
  int refused = 0, overcautious = 0, near = 0;
  for (int repeat = 0; repeat < 1500; ++repeat) {
    const TwoTiles tiles(random);
    const double error = std::exp(uniform(random, -14, -4));
    const bool may = may_be_near(tiles.a, tiles.b, error);
    EXPECT_EQ(may_be_near(tiles.b, tiles.a, error), may);
    bool is = false;
    tiles.each_pair([&](std::size_t i, std::size_t j) {
      const Element &x = tiles.elements[i], &y = tiles.elements[j];
      is = is || moments_error(x, y) > kRounding * error ||
           crossing_error(x, y) > kRounding * kCrossingShare * error;
    });
    EXPECT_TRUE(may || !is);
    refused += may ? 0 : 1;
    near += is ? 1 : 0;
    overcautious += may && !is ? 1 : 0;
  }
  EXPECT_GT(refused, 150) << "the question is of use";
  EXPECT_GT(near, 150);
  EXPECT_LT(overcautious, 600);
}

// So near that the moments rule fails by more than a crossing could.
TEST(TileBounds, SquaresNearerThanTheirSize) {
  std::vector<Element> below(1), above(1);
  for (Element* element : {&below[0], &above[0]}) {
    element->area = 1;
    element->minor_variance = 1.0f / 12;
    element->sides = kFront;
  }
  below[0].normal = {0, 0, 1};
  above[0].normal = {0, 0, -1};
  above[0].centroid = {0, 0, 0.3f};
  const double error = moments_error(below[0], above[0]);
  EXPECT_EQ(crossing_error(below[0], above[0]), 0);
  EXPECT_TRUE(may_be_near(tile_shape(below, 0), tile_shape(above, 0), 0.99 * error));
  EXPECT_FALSE(may_be_near(tile_shape(below, 0), tile_shape(above, 0), 1.01 * error));
}

TEST(TileBounds, NoPairHasALargerShare) {
  std::mt19937 random(3);
  double sharpest = 0;
  for (int repeat = 0; repeat < 300; ++repeat) {
    const TwoTiles tiles(random);
    const bool two_sided = repeat % 2 == 1;
    // A bright tile and a dim one, either of them well lit or not.
    const std::array bright{uniform(random, -8, 8), uniform(random, -8, 8)},
        lit{uniform(random, -8, 8), uniform(random, -8, 8)};
    PowerEstimate power;
    for (std::size_t k = 0; k < TwoTiles::kAll * (two_sided ? 2 : 1); ++k) {
      const std::size_t tile = k % TwoTiles::kAll < TwoTiles::kFirst ? 0 : 1;
      power.B.push_back(std::exp(bright[tile] + uniform(random, -2, 2)));
      power.H.push_back(std::exp(lit[tile] + uniform(random, -2, 2)));
    }
    const double bound = largest_share(tiles.a, tile_power(tiles.elements, 0, power), tiles.b,
                                       tile_power(tiles.elements, 1, power));
    double largest = 0;
    tiles.each_pair([&](std::size_t i, std::size_t j) {
      const Element &x = tiles.elements[i], &y = tiles.elements[j];
      const double F_ij = pair_form_factor(PairRule::point, x, y),
                   F_ji = pair_form_factor(PairRule::point, y, x);
      for (const std::size_t from : {i, two_sided ? i + TwoTiles::kAll : i})
        for (const std::size_t to : {j, two_sided ? j + TwoTiles::kAll : j})
          largest = std::max(largest, power.share(from, to, F_ij, F_ji));
    });
    EXPECT_LE(largest, kRounding * bound);
    sharpest = std::max(sharpest, largest / bound);
  }
  EXPECT_GT(sharpest, 0.3);
}

TEST(TileBounds, OnlyTheMomentsRuleGivesWay) {
  const TileShape here{glm::vec3(0), glm::vec3(1), 0.01, 0.002},
      there{glm::vec3(10), glm::vec3(11), 0.01, 0.002};
  // 9 apart on each axis, so that point_error is 2 * 0.004 / 243.
  constexpr double kError = 2 * 0.004 / 243;
  EXPECT_EQ(rule_between(here, there, {PairRule::moments, 0.99 * kError}), PairRule::moments);
  EXPECT_EQ(rule_between(here, there, {PairRule::moments, 1.01 * kError}), PairRule::point);
  EXPECT_EQ(rule_between(there, here, {PairRule::moments, 1.01 * kError}), PairRule::point);
  EXPECT_EQ(rule_between(here, there, PairRule::moments), PairRule::moments);
  EXPECT_EQ(rule_between(here, here, {PairRule::moments, 1}), PairRule::moments) << "tiles that overlap";
  EXPECT_EQ(rule_between(here, there, {PairRule::disc, 1}), PairRule::disc);
  EXPECT_EQ(rule_between(here, there, {PairRule::point, 0}), PairRule::point);
}

TEST(TileBounds, WhereThePointRuleIsTakenItIsGoodEnough) {
  std::mt19937 random(4);
  constexpr double kFarError = 0.01;
  int far = 0;
  double worst = 0;
  for (int repeat = 0; repeat < 20'000; ++repeat) {
    // Tiles of one element: the pair is as near as its tiles.
    const glm::dvec3 apart = uniform(random, 3, 20) * test_scenes::random_direction(random);
    closed_forms::Polygon x, y;
    const std::vector<Element> one{random_element(glm::dvec3(0), 1, random, &x)},
        other{random_element(apart, uniform(random, 0.3, 1), random, &y)};
    if (rule_between(tile_shape(one, 0), tile_shape(other, 0), {PairRule::moments, kFarError}) !=
        PairRule::point)
      continue;
    if (crossing_error(one[0], other[0]) > 0) continue;
    const auto facing = [](const closed_forms::Polygon& of, const glm::dvec3& towards) {
      const bool front = glm::dot(closed_forms::vector_area(of), towards) > 0;
      return front ? of : closed_forms::Polygon(of.rbegin(), of.rend());
    };
    ++far;
    const double exact = closed_forms::polygon_to_polygon(facing(x, apart), facing(y, -apart));
    const double point = pair_form_factor(PairRule::point, one[0], other[0]);
    const double unit = static_cast<double>(other[0].area) / (std::numbers::pi * glm::dot(apart, apart));
    worst = std::max(worst, std::abs(point - exact) / unit / kFarError);
  }
  EXPECT_GT(far, 1000);
  EXPECT_LT(worst, 1.05) << "terms of higher order";
  EXPECT_GT(worst, 0.3);
}

}  // namespace
}  // namespace fluxel
