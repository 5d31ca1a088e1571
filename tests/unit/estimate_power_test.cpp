#include "solver/estimate_power.hpp"

#include <gtest/gtest.h>

#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using test_scenes::DenseOperator;

Unknowns unknowns_of(std::vector<Rgb> E, std::vector<Rgb> rho, std::vector<double> area) {
  Unknowns unknowns;
  unknowns.elements = unknowns.active = E.size();
  unknowns.E = std::move(E);
  unknowns.rho = std::move(rho);
  unknowns.area = std::move(area);
  return unknowns;
}

// In a closed room with equal E and rho the ambient term is the solution: B = E / (1 - rho).
TEST(EstimatePower, IsExactInAFurnace) {
  std::mt19937 random(1);
  DenseOperator F(test_scenes::random_matrix(20, 1, random));
  const Rgb E(1, 2, 0.5), rho(0.5, 0.25, 0.8);
  const PowerEstimate power = estimate_power(
      F, unknowns_of(std::vector<Rgb>(20, E), std::vector<Rgb>(20, rho), std::vector<double>(20, 0.3)));
  const Rgb B = E / (Rgb(1) - rho);
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_NEAR(power.B[i], B.r + B.g + B.b, 1e-12);
    EXPECT_NEAR(power.H[i], B.r + B.g + B.b, 1e-12) << "rows add up to 1";
  }
}

// Worked by hand: ambient = 2 * 1 / (2 * 1 + 3 * 0.5); B0 = (1, ambient / 2), H = (B0_2 / 4, B0_1 / 2).
TEST(EstimatePower, ByHand) {
  DenseOperator F({{0, 0.25}, {0.5, 0}});
  const PowerEstimate power =
      estimate_power(F, unknowns_of({Rgb(1, 0, 0), Rgb(0)}, {Rgb(0), Rgb(0.5)}, {2, 3}));
  const double ambient = 2 / 3.5;
  EXPECT_NEAR(power.H[0], ambient / 8, 1e-15);
  EXPECT_NEAR(power.H[1], 0.5, 1e-15);
  EXPECT_NEAR(power.B[0], 1, 1e-15);
  EXPECT_NEAR(power.B[1], 0.25, 1e-15);
}

// A pair that heat is drawn by is worth as much as one that sends it: signs do not count.
TEST(EstimatePower, DrawnHeatCountsAsSentHeat) {
  DenseOperator F({{0, 0.25}, {0.5, 0}});
  const auto estimate = [&](double drawn) {
    return estimate_power(F, unknowns_of({Rgb(4), Rgb(drawn)}, {Rgb(0.5), Rgb(1)}, {2, 3}));
  };
  const PowerEstimate sent = estimate(1), drawn = estimate(-1);
  EXPECT_EQ(drawn.B, sent.B);
  EXPECT_EQ(drawn.H, sent.H);
  EXPECT_GT(drawn.B[1], 0);
}

TEST(EstimatePower, OfLightThatIsKnownIsThatLight) {
  const std::vector<Rgb> B{Rgb(1, 2, 3), Rgb(0, 0, -4)}, H{Rgb(2, 0, 0), Rgb(0)};
  const PowerEstimate power = power_of_light({}, B, H);
  EXPECT_EQ(power.B, (std::vector<double>{6, 4}));
  EXPECT_EQ(power.H[0], 2);
  EXPECT_GT(power.H[1], 0);
  EXPECT_LT(power.H[1], 1e-3);
}

TEST(EstimatePower, IrradianceStaysAboveNothing) {
  // The third sees nothing.
  DenseOperator F({{0, 0.5, 0}, {0.5, 0, 0}, {0, 0, 0}});
  const Unknowns lit = unknowns_of({Rgb(1), Rgb(0), Rgb(0)}, std::vector<Rgb>(3, Rgb(0.5)), {1, 1, 1});
  const PowerEstimate power = estimate_power(F, lit);
  EXPECT_GT(power.H[2], 0);
  EXPECT_LT(power.H[2], 1e-3 * power.H[0]);
}

TEST(EstimatePower, NoLightAndNoAbsorptionStayFinite) {
  DenseOperator F({{0, 1}, {1, 0}});
  for (const Rgb& rho : {Rgb(0), Rgb(0.5), Rgb(1)}) {
    for (const Rgb& E : {Rgb(0), Rgb(1)}) {
      const PowerEstimate power = estimate_power(F, unknowns_of({E, Rgb(0)}, {rho, rho}, {1, 1}));
      for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_TRUE(std::isfinite(power.B[i]));
        EXPECT_GT(power.H[i], 0);
        EXPECT_TRUE(std::isfinite(power.H[i]));
      }
      EXPECT_TRUE(std::isfinite(power.share(0, 1, 1, 1)));
      EXPECT_EQ(power.share(0, 1, 1, 1) > 0, E != Rgb(0)) << "without light no pair is worth a ray";
    }
  }
}

TEST(PowerEstimate, ShareIsTheLargerOfBothWays) {
  const PowerEstimate power{{3, 1}, {2, 10}};
  EXPECT_DOUBLE_EQ(power.share(0, 1, 0.5, 0.1), 0.25);  // 0.5 * 1 / 2 against 0.1 * 3 / 10
  EXPECT_DOUBLE_EQ(power.share(1, 0, 0.1, 0.5), 0.25);
}

}  // namespace
}  // namespace fluxel
