#include "formfactor/exchange.hpp"

#include <gtest/gtest.h>

#include "tests/closed_forms/closed_forms.hpp"
#include "tests/closed_forms/shapes.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using closed_forms::Rectangle;

SampledPolygon sampled(const closed_forms::Polygon& polygon) {
  return {{polygon.begin(), polygon.end()}, glm::normalize(closed_forms::vector_area(polygon))};
}

/// Two polygons that face each other and what stands between, as a scene.
struct Pair {
  Scene scene = by_hand::empty_scene(Sides::one);
  SampledPolygon P, Q;

  Pair(const closed_forms::Polygon& from, const closed_forms::Polygon& to,
       const std::vector<closed_forms::Polygon>& blockers)
      : P(sampled(from)), Q(sampled(to)) {
    by_hand::add(scene, "from", from);
    by_hand::add(scene, "to", to);
    for (const closed_forms::Polygon& blocker : blockers) by_hand::add(scene, "blocker", blocker);
    scene = test_scenes::finished(std::move(scene));
  }

  [[nodiscard]] Exchange exchange(const ExchangeTolerance& tolerance, std::uint64_t seed = 1,
                                  const std::optional<Exchange>& free = {}) const {
    const RayScene ray_scene(scene, 1);
    return exchange_past(occlusion(ray_scene), {P, Q, all(), seed}, tolerance, free);
  }

  [[nodiscard]] std::optional<Exchange> past_few(const Exchange& free, double tolerance,
                                                 std::size_t most) const {
    const RayScene ray_scene(scene, 1);
    return exchange_past_few(occlusion(ray_scene), {P, Q, all()}, free, tolerance, most);
  }

 private:
  [[nodiscard]] OcclusionScene occlusion(const RayScene& ray_scene) const {
    return {ray_scene, scene, 1e-10 * scene.extent};
  }
  [[nodiscard]] std::vector<PatchId> all() const {
    std::vector<PatchId> patches;
    for (std::uint32_t k = 0; k < scene.patches.size(); ++k) patches.push_back(PatchId{k});
    return patches;
  }
};

/// Opposed unit squares 1 m apart and plates half way between.
Pair opposed(const std::vector<Rectangle>& blockers) {
  std::vector<closed_forms::Polygon> plates;
  for (const Rectangle& blocker : blockers) plates.push_back(closed_forms::horizontal(blocker, 0.5));
  constexpr Rectangle kUnit{0, 1, 0, 1};
  return {closed_forms::horizontal(kUnit, 0), closed_forms::reversed(closed_forms::horizontal(kUnit, 1)),
          plates};
}

const std::vector<Rectangle> kHalf{{0, 0.5, 0, 1}}, kQuadrant{{0, 0.5, 0, 0.5}},
    kSlats{{0, 0.25, 0, 1}, {0.5, 0.75, 0, 1}};

/// So narrow that parts of the squares still have more of them between than are clipped.
std::vector<Rectangle> many_slats() {
  std::vector<Rectangle> slats;
  for (int k = 0; k < 100; ++k) slats.push_back({k / 100.0, (k + 0.5) / 100, 0, 1});
  return slats;
}

TEST(FreeExchange, ErrsByNoMoreThanItSays) {
  struct Known {
    Pair pair;
    double exact;
  };
  const auto [lying, raised] = closed_forms::hinged_squares(std::numbers::pi / 3);
  for (const Known& known :
       {Known{opposed({}), closed_forms::opposed_rectangles(1, 1, 1)},
        Known{{lying, raised, {}}, closed_forms::polygon_to_polygon(lying, raised)},
        Known{{closed_forms::horizontal({0, 2, 0, 1}, 0), closed_forms::facing_x({0, 1, 0, 1}, 0), {}},
              2 * closed_forms::adjacent_rectangles(2, 1, 1)}}) {
    for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
      const Exchange found = free_exchange(known.pair.P, known.pair.Q, tolerance);
      EXPECT_NEAR(found.G, known.exact, found.error);
      EXPECT_LE(found.error, tolerance);
      EXPECT_EQ(found.variance, 0);
      EXPECT_EQ(found.rays, 0u);
    }
  }
}

// Triangles at all distances over a square, flat ones with edges that pass its edges closely, and steep ones
// of which the planes cut off parts.
TEST(FreeExchange, ErrsByNoMoreThanItSaysWhereverEdgesPass) {
  std::mt19937 random(1);
  const Polygon square = closed_forms::horizontal({0, 1, 0, 1}, 0);
  int compared = 0;
  for (int k = 0; k < 500; ++k) {
    const double height = std::pow(10.0, test_scenes::uniform(random, -2.5, 1.5));
    const auto corner = [&] {
      return glm::dvec3(1, 1, height) * test_scenes::uniform_point(random, -0.5, 1.5);
    };
    Polygon triangle{corner(), corner(), corner()};
    if (area_vector(triangle).z > 0) std::ranges::reverse(triangle);
    const glm::dvec3 normal = glm::normalize(area_vector(triangle));
    const SampledPolygon P{clip_to_front(square, {triangle[0], normal}), {0, 0, 1}};
    const SampledPolygon Q{clip_to_front(triangle, {{0, 0, 0}, {0, 0, 1}}), normal};
    if (P.corners.empty() || Q.corners.empty()) continue;
    const double exact = closed_forms::exchange_area(square, triangle);
    for (const double tolerance : {1e-9, 1e-5, 1.0}) {
      const Exchange found = free_exchange(P, Q, tolerance);
      EXPECT_NEAR(found.G, exact, found.error + 1e-13) << k << ' ' << tolerance;
    }
    ++compared;
  }
  EXPECT_GT(compared, 100);
}

TEST(ExchangePast, WhatIsKnownIsTakenWhereNothingStandsBetween) {
  const Exchange known{0.123, 0.01, 0, 0};
  const ExchangeTolerance tolerance{1e-6, 1e-6};
  EXPECT_EQ(opposed({}).exchange(tolerance, 1, known).G, known.G);
  EXPECT_EQ(opposed({{0, 1, 0, 1}}).exchange(tolerance, 1, known).G, 0);
}

TEST(ExchangePast, WhatStandsBesideCostsNoRay) {
  const Pair beside = opposed({{1, 2, 0, 1}, {-1, 2, 1, 2}});
  const Exchange found = beside.exchange({1e-6, 1e-6});
  EXPECT_NEAR(found.G, closed_forms::opposed_rectangles(1, 1, 1), 1e-6);
  EXPECT_EQ(found.rays, 0u);
  EXPECT_EQ(found.variance, 0);
}

TEST(ExchangePast, NothingPassesAPlateThatHidesAll) {
  for (const Rectangle& plate : {Rectangle{0, 1, 0, 1}, Rectangle{-3, 4, -1, 2}}) {
    const Exchange found = opposed({plate}).exchange({1e-6, 1e-6});
    EXPECT_EQ(found.G, 0);
    EXPECT_EQ(found.total_error(), 0);
    EXPECT_EQ(found.rays, 0u);
  }
}

// Two plates of which each hides a part, together all, with the seam in the middle: no ray is lost there.
TEST(ExchangePast, PlatesThatHideAllTogether) {
  const Exchange found = opposed({{-1, 0.5, -1, 2}, {0.5, 2, -1, 2}}).exchange({1e-4, 1e-3});
  EXPECT_EQ(found.G, 0);
}

TEST(ExchangePast, AHiddenPartIsFoundWithinTheEstimatedErrors) {
  for (const std::vector<Rectangle>& blockers : {kHalf, kQuadrant, kSlats}) {
    const Pair pair = opposed(blockers);
    const double exact = closed_forms::opposed_squares_past(blockers);
    for (const double tolerance : {3e-3, 3e-4, 3e-5}) {
      const Exchange found = pair.exchange({1e-5, tolerance});
      EXPECT_NEAR(found.G, exact, found.total_error()) << tolerance;
      EXPECT_LE(found.total_error(), 1e-5 + tolerance);
      EXPECT_EQ(found.rays, 0u);
    }
  }
}

TEST(ExchangePast, WhatManyHideIsFoundByRays) {
  const Pair pair = opposed(many_slats());
  const double exact = closed_forms::opposed_squares_past(many_slats());
  int within_one = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Exchange found = pair.exchange({1e-5, 3e-3}, seed);
    EXPECT_NEAR(found.G, exact, 3 * found.total_error()) << seed;
    EXPECT_LE(found.total_error(), 1e-5 + 3e-3);
    EXPECT_GT(found.rays, 0u);
    within_one += std::abs(found.G - exact) <= found.total_error() ? 1 : 0;
  }
  EXPECT_GE(within_one, 5);
}

// Far squares and plates half way between, of which each mirror image fills what the plates leave: they hide
// half.
TEST(ExchangePast, AFewShadowsAreClipped) {
  const auto far = [](const std::vector<Rectangle>& blockers) {
    std::vector<closed_forms::Polygon> plates;
    for (const Rectangle& blocker : blockers) plates.push_back(closed_forms::horizontal(blocker, 2));
    constexpr Rectangle kUnit{0, 1, 0, 1};
    return Pair{closed_forms::horizontal(kUnit, 0),
                closed_forms::reversed(closed_forms::horizontal(kUnit, 4)), plates};
  };
  const Exchange free{.G = closed_forms::opposed_rectangles(1, 1, 4)};
  const std::vector<Rectangle> diagonal{{0, 0.5, 0, 0.5}, {0.5, 1, 0.5, 1}};
  EXPECT_EQ(far({}).past_few(free, 1e-5, 1).value().G, free.G);
  EXPECT_EQ(far({{1, 2, 0, 1}, {-1, 2, 1, 2}}).past_few(free, 1e-5, 1).value().G, free.G) << "stand beside";
  EXPECT_EQ(far({{0, 1, 0, 1}}).past_few(free, 1e-5, 1).value().G, 0);
  EXPECT_EQ(far({{-1, 0.5, -1, 2}, {0.5, 2, -1, 2}}).past_few(free, 1e-5, 2).value().G, 0);
  EXPECT_FALSE(far({{0, 0.6, 0, 0.4}}).past_few(free, 1e-12, 1).has_value()) << "not that exactly";
  EXPECT_FALSE(opposed(kHalf).past_few(free, 1e-3, 1).has_value()) << "too near";
  for (const std::vector<Rectangle>& blockers : {kHalf, diagonal}) {
    for (const double part : {1e-2, 1e-3, 1e-4}) {
      const std::optional<Exchange> found = far(blockers).past_few(free, part * free.G, blockers.size());
      ASSERT_TRUE(found.has_value());
      EXPECT_NEAR(found->G, free.G / 2, part * free.G);
      EXPECT_LE(found->total_error(), part * free.G);
    }
    EXPECT_FALSE(far(blockers).past_few(free, 1e-3 * free.G, blockers.size() - 1).has_value());
  }
}

// A board that stands on the sender hides all of the receiver from one half of it, down to its foot.
TEST(ExchangePast, ABoardThatTouchesTheSender) {
  const Pair pair{closed_forms::horizontal({0, 2, 0, 1}, 0),
                  closed_forms::facing_x({0, 1, 0, 1}, 0),
                  {{{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}}}};
  // The floor beyond the board sees what is above the line from it over the board's top: nothing of a wall as
  // high as the board. This side's floor sees it all.
  const Exchange found = pair.exchange({1e-6, 1e-4});
  EXPECT_NEAR(found.G, closed_forms::adjacent_rectangles(1, 1, 1), 3 * found.total_error());
  EXPECT_LE(found.total_error(), 2e-4);
}

TEST(ExchangePast, ASeedAlwaysGivesTheSame) {
  const Pair pair = opposed(many_slats());
  const Exchange first = pair.exchange({1e-4, 1e-2}, 5), again = pair.exchange({1e-4, 1e-2}, 5),
                 other = pair.exchange({1e-4, 1e-2}, 6);
  EXPECT_EQ(first.G, again.G);
  EXPECT_EQ(first.rays, again.rays);
  EXPECT_NE(first.G, other.G);
}

// What matters less than the tolerance is half of it, give or take that half.
TEST(ExchangePast, WhatIsTooSmallToMatterTakesNoRays) {
  const Exchange found = opposed(kHalf).exchange({0.1, 0.3});
  EXPECT_EQ(found.rays, 0u);
  EXPECT_NEAR(found.G, closed_forms::opposed_rectangles(1, 1, 1) / 2, 1e-4);
  EXPECT_LE(found.total_error(), 0.1001);
}

TEST(Exchange, ErrorsOfQuadratureAddAndThoseOfRaysInTheirSquares) {
  Exchange sum{1, 0.1, 0.09, 10};
  sum += {2, 0.2, 0.16, 5};
  EXPECT_EQ(sum.G, 3);
  EXPECT_NEAR(sum.error, 0.3, 1e-15);
  EXPECT_NEAR(sum.total_error(), 0.3 + 0.5, 1e-15);
  EXPECT_EQ(sum.rays, 15u);
}

}  // namespace
}  // namespace fluxel
