#include "formfactor/visible_fraction.hpp"

#include <gtest/gtest.h>

#include "formfactor/free_segments.hpp"
#include "tests/closed_forms/closed_forms.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

/// Unit squares at z = 0 and z = 1 that face each other, and plates between them at z = 1/2.
struct Opposed {
  Scene scene = by_hand::empty_scene(Sides::one);
  SampledPolygon below{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 0, 1}};
  SampledPolygon above{{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}, {0, 0, -1}};

  explicit Opposed(const std::vector<closed_forms::Rectangle>& blockers) {
    by_hand::add(scene, "below", {below.corners.begin(), below.corners.end()});
    by_hand::add(scene, "above", {above.corners.begin(), above.corners.end()});
    for (const auto& [x0, x1, y0, y1] : blockers)
      by_hand::add(scene, "blocker", {{x0, y0, 0.5}, {x1, y0, 0.5}, {x1, y1, 0.5}, {x0, y1, 0.5}});
    scene = test_scenes::finished(std::move(scene));
  }

  [[nodiscard]] VisibleFraction fraction(std::uint64_t seed, const RayBudget& budget) const {
    return visible_fraction(RayScene(scene, 1), below, above, seed, budget);
  }

  [[nodiscard]] FractionEstimate estimate(std::uint64_t seed, double wanted) const {
    return estimate_fraction(RayScene(scene, 1), below, above, seed, wanted);
  }

  /// Root mean square error over the seeds whose first rays found that the pair is partly visible: nearly
  /// all.
  [[nodiscard]] double error(const RayBudget& budget, double exact, std::uint64_t seeds) const {
    const RayScene ray_scene(scene, 1);
    double sum = 0, found_partial = 0;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      const double value = visible_fraction(ray_scene, below, above, seed, budget).value;
      if (value == 0 || value == 1) continue;
      sum += (value - exact) * (value - exact);
      ++found_partial;
    }
    EXPECT_GT(found_partial, 0.97 * static_cast<double>(seeds));
    return std::sqrt(sum / found_partial);
  }
};

constexpr RayBudget kMaxRays{1, 1e-6};

/// The budget that asks for about this many rays of a partly visible pair.
RayBudget budget_of(double rays) { return {2 * std::pow(rays, 2.0 / 3) * 1e-4, 1e-4}; }
/// And for as many where they agree.
RayBudget budget_without_pilots(double rays) { return {1, 0.5 * std::pow(rays, -2.0 / 3), 0.5 / rays}; }

/// The blockers whose visible fractions are known, and that.
struct KnownBlocker {
  std::vector<closed_forms::Rectangle> blockers;
  double exact;
};

std::vector<KnownBlocker> known_blockers() {
  std::vector<KnownBlocker> known;
  for (const closed_forms::Rectangle& blocker :
       {closed_forms::Rectangle{0, 0.5, 0, 1}, closed_forms::Rectangle{0, 0.5, 0, 0.5},
        closed_forms::centred_blocker(0.5)}) {
    const std::array one{blocker};
    known.push_back(
        {{blocker}, closed_forms::opposed_squares_past(one) / closed_forms::opposed_rectangles(1, 1, 1)});
  }
  return known;
}

TEST(VisibleFraction, NothingBetweenIsOneExactly) {
  const Opposed free({}), beside({{1.1, 2, 0, 1}});
  for (std::uint64_t seed = 0; seed < 50; ++seed)
    for (const Opposed* scene : {&free, &beside}) EXPECT_EQ(scene->fraction(seed, kMaxRays).value, 1);
}

TEST(VisibleFraction, AllBetweenIsNothingExactly) {
  const Opposed blocked({{-0.5, 1.5, -0.5, 1.5}});
  for (std::uint64_t seed = 0; seed < 50; ++seed) EXPECT_EQ(blocked.fraction(seed, kMaxRays).value, 0);
}

// Of n rays that agree half a ray's share may have been missed.
TEST(VisibleFraction, RaysThatAgreeAreAsManyAsTheShareIsWorth) {
  const Opposed free({}), blocked({{-0.5, 1.5, -0.5, 1.5}});
  for (const Opposed* scene : {&free, &blocked}) {
    EXPECT_EQ(scene->fraction(1, {1e-3, 1e-9, 5e-4}).rays, kMinPairRays);
    EXPECT_EQ(scene->fraction(1, {0.1, 1e-9, 5e-4}).rays, 112u) << "100, and packets are full";
    EXPECT_EQ(scene->fraction(1, {0.1, 1, 5e-4}).rays, 112u);
    EXPECT_EQ(scene->fraction(1, {1, 1e-9, 1e-9}).rays, kMaxPairRays);
  }
}

TEST(VisibleFraction, KnownBlockers) {
  for (const auto& [blockers, exact] : known_blockers()) {
    const Opposed scene(blockers);
    const double rms = scene.error(kMaxRays, exact, 256);
    EXPECT_LT(rms, 0.007) << exact;
    // The mean over seeds tells of a bias.
    double mean = 0;
    for (std::uint64_t seed = 0; seed < 256; ++seed) mean += scene.fraction(seed, kMaxRays).value / 256;
    EXPECT_NEAR(mean, exact, 4 * rms / 16);
  }
}

// Were rays that agree the answer, what is mostly seen would be too bright and what is mostly hidden too
// dark.
TEST(VisibleFraction, RaysThatDecideHowManyFollowAreNoneOfThem) {
  constexpr int kSeeds = 4000;
  for (const closed_forms::Rectangle& blocker :
       {closed_forms::centred_blocker(0.2), closed_forms::Rectangle{-0.5, 0.9, -0.5, 1.5}}) {
    const std::array one{blocker};
    const double exact = closed_forms::opposed_squares_past(one) / closed_forms::opposed_rectangles(1, 1, 1);
    const Opposed scene({blocker});
    const RayScene ray_scene(scene.scene, 1);
    double sum = 0, squares = 0;
    std::uint64_t agreed = 0;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const VisibleFraction found = visible_fraction(ray_scene, scene.below, scene.above, seed, {1, 0.03, 1});
      EXPECT_EQ(found.pilots, 16U);
      EXPECT_EQ(found.rays, found.agree ? 16U : 80U);
      agreed += found.rays == 16 ? 1 : 0;
      sum += found.value;
      squares += found.value * found.value;
    }
    const double mean = sum / kSeeds, standard_error = std::sqrt((squares / kSeeds - mean * mean) / kSeeds);
    EXPECT_GT(agreed, kSeeds / 10);
    EXPECT_LT(agreed, 9 * kSeeds / 10);
    EXPECT_NEAR(mean, exact, 4 * standard_error);
    EXPECT_LT(standard_error, 0.04 * std::min(exact, 1 - exact)) << "or a bias would not show";
  }
}

TEST(VisibleFraction, TheBudgetDecidesHowManyRays) {
  const Opposed half({{0, 0.5, 0, 1}});
  EXPECT_EQ(half.fraction(1, {0, 1e-4}).rays, kMinPairRays);
  EXPECT_EQ(half.fraction(1, {1, 1e-9}).rays, kMaxPairRays);
  EXPECT_EQ(half.fraction(1, budget_of(65.5)).rays, 80u) << "packets are full";
  EXPECT_EQ(half.fraction(1, budget_of(63.5)).rays, 64u);
}

// Independent rays would give a slope of -1/2.
TEST(VisibleFraction, TheErrorFallsWithTheRays) {
  for (const auto& [blockers, exact] : known_blockers()) {
    const Opposed scene(blockers);
    const double few = scene.error(budget_without_pilots(31), exact, 512),
                 many = scene.error(budget_without_pilots(1023), exact, 512);
    const double slope = std::log(many / few) / std::log(1024.0 / 32);
    EXPECT_LT(slope, -0.6) << few << ' ' << many;
  }
}

TEST(VisibleFraction, SeedsAreIndependent) {
  const Opposed half({{0, 0.5, 0, 1}});
  const double exact = 0.5;
  // The mean over 16 seeds that err independently errs by a quarter of one.
  const RayScene ray_scene(half.scene, 1);
  double of_one = 0, of_means = 0;
  for (std::uint64_t group = 0; group < 32; ++group) {
    double mean = 0;
    for (std::uint64_t k = 0; k < 16; ++k) {
      const double error =
          visible_fraction(ray_scene, half.below, half.above, group << 32 | k, budget_of(127)).value - exact;
      mean += error / 16;
      of_one += error * error / (16 * 32);
    }
    of_means += mean * mean / 32;
  }
  EXPECT_GT(of_one, 0);
  EXPECT_LT(of_means, 2 * of_one / 16);
  EXPECT_EQ(half.fraction(7, kMaxRays).value, half.fraction(7, kMaxRays).value);
  EXPECT_NE(half.fraction(7, kMaxRays).value, half.fraction(8, kMaxRays).value);
}

TEST(EstimateFraction, OnePacketTellsWhatNothingStandsIn) {
  const Opposed free({}), blocked({{-0.5, 1.5, -0.5, 1.5}});
  const FractionEstimate open = free.estimate(1, 0.05), dark = blocked.estimate(1, 0.05);
  EXPECT_EQ(open.value, 1);
  EXPECT_EQ(dark.value, 0);
  for (const FractionEstimate& found : {open, dark}) {
    EXPECT_EQ(found.rays, 16u);
    EXPECT_EQ(found.error, 1.0 / 32);
  }
  // More where an error of 1/32 is too much: one of 2 n may still have been missed.
  const FractionEstimate careful = free.estimate(1, 1e-3);
  EXPECT_EQ(careful.value, 1);
  EXPECT_EQ(careful.rays, 512u);
  EXPECT_EQ(careful.error, 1.0 / 1024);
}

TEST(EstimateFraction, TheErrorIsAsWantedOrTheRaysAreSpent) {
  const Opposed scene({{0, 0.5, 0, 0.5}});
  std::uint64_t last = 0;
  for (const double wanted : {0.03, 0.01, 0.003, 0.001}) {
    const FractionEstimate found = scene.estimate(3, wanted);
    EXPECT_LE(found.error, wanted);
    EXPECT_GT(found.error, 0);
    EXPECT_GE(found.rays, last);
    last = found.rays;
  }
  const FractionEstimate spent = scene.estimate(3, 0);
  EXPECT_EQ(spent.rays, kMaxEstimateRays);
  EXPECT_GT(spent.error, 0);
}

TEST(EstimateFraction, TheErrorCoversTheTruthAsOftenAsAStandardError) {
  constexpr int kSeeds = 500;
  for (const auto& [blockers, exact] : known_blockers()) {
    const Opposed scene(blockers);
    for (const double wanted : {0.02, 0.005}) {
      int within_a_third = 0, within_one = 0, within_three = 0;
      for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        const FractionEstimate found = scene.estimate(seed, wanted);
        const double ratio = std::abs(found.value - exact) / found.error;
        within_a_third += ratio <= 1.0 / 3 ? 1 : 0;
        within_one += ratio <= 1 ? 1 : 0;
        within_three += ratio <= 3 ? 1 : 0;
      }
      // Of a normal distribution 26, 68 and 99.7 of a hundred; eight values know their spread to a quarter.
      EXPECT_LE(within_a_third, 0.36 * kSeeds) << "no exaggeration: " << exact << ' ' << wanted;
      EXPECT_GE(within_one, 0.63 * kSeeds) << exact << ' ' << wanted;
      EXPECT_GE(within_three, 0.955 * kSeeds) << exact << ' ' << wanted;
    }
  }
}

// Beside a small face a large floor is seen near the face alone: few of the floor's places bring all of it.
TEST(VisibleFraction, FewRaysAreRightInTheMeanBesideASmallFace) {
  const auto rectangle = [](double x0, double x1) {
    return SmallPolygon{{x0, -5, 0}, {x1, -5, 0}, {x1, 5, 0}, {x0, 5, 0}};
  };
  const SampledPolygon floor{rectangle(0, 10), {0, 0, 1}};
  const SampledPolygon face{{{0, 0, 0.001}, {0, 0.1, 0.001}, {0, 0.1, 0.1}, {0, 0, 0.1}}, {1, 0, 0}};
  constexpr double kScreen = 0.2;  // hides what lies beyond
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "floor", {floor.corners.begin(), floor.corners.end()});
  by_hand::add(scene, "face", {face.corners.begin(), face.corners.end()});
  by_hand::add(scene, "screen", {{kScreen, -9, 0}, {kScreen, -9, 1}, {kScreen, 9, 1}, {kScreen, 9, 0}});
  scene = test_scenes::finished(std::move(scene));
  const auto exchange = [&face](const SmallPolygon& of_floor) {
    return exchange_area_by_contour(corners(face.corners), corners(of_floor), ContourPoints::fine);
  };
  const double exact = exchange(rectangle(0, kScreen)) / exchange(floor.corners);
  const RayScene ray_scene(scene, 1);
  constexpr int kSeeds = 2000;
  double mean = 0, other_way = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    mean += visible_fraction(ray_scene, face, floor, seed, {0, 1}).value / kSeeds;
    other_way += visible_fraction(ray_scene, floor, face, seed, {0, 1}).value / kSeeds;
  }
  EXPECT_GT(exact, 0.7);
  EXPECT_NEAR(mean / exact, 1, 0.01);
  EXPECT_EQ(other_way, mean);
}

// A triangle that touches a square along an edge: the surfaces themselves hide nothing.
TEST(VisibleFraction, MeanPlacesOfWhatIsSeen) {
  // The half of small x is hidden at half height: of the segments those with x + x' > 1 pass.
  const Opposed half({{-1, 0.5, -1, 2}});
  constexpr int kAlong = 20;
  double sum = 0, x_sum = 0;
  const auto at = [](int k) { return (k + 0.5) / kAlong; };
  for (int a = 0; a < kAlong; ++a)
    for (int b = 0; b < kAlong; ++b)
      for (int c = 0; c < kAlong; ++c)
        for (int d = 0; d < kAlong; ++d) {
          const double r2 = std::pow(at(a) - at(c), 2) + std::pow(at(b) - at(d), 2) + 1;
          // The diagonal cells are cut in half.
          const double weight = (a + c > kAlong - 1 ? 1 : a + c == kAlong - 1 ? 0.5 : 0) / (r2 * r2);
          sum += weight;
          x_sum += weight * at(a);
        }
  const RayScene ray_scene(half.scene, 1);
  glm::dvec3 at_P(0), at_Q(0);
  constexpr int kSeeds = 40;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const VisibleFraction found = visible_fraction(ray_scene, half.below, half.above, seed, kMaxRays);
    at_P += found.at_P / double{kSeeds};
    at_Q += found.at_Q / double{kSeeds};
  }
  for (const glm::dvec3& place : {at_P, at_Q}) {
    EXPECT_NEAR(place.x, x_sum / sum, 4e-3);
    EXPECT_NEAR(place.y, 0.5, 4e-3);
  }
  EXPECT_NEAR(at_P.z, 0, 1e-12);
  EXPECT_NEAR(at_Q.z, 1, 1e-12);

  // Whichever of the two is the smaller.
  SampledPolygon part = half.above;
  for (glm::dvec3& corner : part.corners) corner.x = 0.5 + 0.5 * corner.x;
  EXPECT_NEAR(visible_fraction(ray_scene, half.below, part, 1, kMaxRays).at_Q.z, 1, 1e-12);
  EXPECT_NEAR(visible_fraction(ray_scene, part, half.below, 1, kMaxRays).at_Q.z, 0, 1e-12);
}

TEST(VisibleFraction, TouchingSurfacesDoNotHideThemselves) {
  std::mt19937 random(1);
  for (int repeat = 0; repeat < 20; ++repeat) {
    Scene scene = by_hand::empty_scene(Sides::one);
    by_hand::add(scene, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    by_hand::add(scene, "wall", {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    by_hand::rotate(scene, by_hand::random_rotation(random));
    scene = test_scenes::finished(std::move(scene));
    const auto sampled = [&](std::size_t patch) {
      const PolygonView view = corners(scene.patches[patch].outline);
      return SampledPolygon{{view.begin(), view.end()}, scene.patches[patch].normal};
    };
    const RayScene ray_scene(scene, 1);
    for (std::uint64_t seed = 0; seed < 50; ++seed)
      EXPECT_EQ(visible_fraction(ray_scene, sampled(0), sampled(1), seed, kMaxRays).value, 1);
  }
}

TEST(FreeSegments, BitsNameTheirSegments) {
  const Opposed half({{0, 0.5, 0, 1}});
  const RayScene ray_scene(half.scene, 1);
  std::vector<SurfaceSegment> segments;
  for (const double x : {0.25, 0.75, 0.1, 0.9, 0.6})
    segments.push_back({{x, 0.5, 0}, {0, 0, 1}, {x, 0.5, 1}, {0, 0, -1}});
  EXPECT_EQ(free_segments(ray_scene, segments), 0b11010u);
  EXPECT_EQ(free_segments(ray_scene, std::span(segments).subspan(1, 2)), 0b01u);
  EXPECT_EQ(free_segments(ray_scene, {}), 0u);
}

}  // namespace
}  // namespace fluxel
