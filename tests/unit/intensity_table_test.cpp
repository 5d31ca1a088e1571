#include "scene/intensity_table.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace fluxel::intensity_table_test {
namespace {

constexpr double kPi = std::numbers::pi;

double radians(double degrees) { return degrees / 180 * kPi; }

/// A table of a function of C and gamma [degrees].
template <class Function>
IntensityTable make_table(std::vector<double> C, std::vector<double> gamma, Function I) {
  IntensityTable table;
  for (const double c : C)
    for (const double g : gamma) table.intensity.push_back(I(c, g));
  for (const double c : C) table.C.push_back(radians(c));
  for (const double g : gamma) table.gamma.push_back(radians(g));
  return table;
}

std::vector<double> steps(double from, double to, int count) {
  std::vector<double> angles;
  for (int k = 0; k <= count; ++k) angles.push_back(from + (to - from) * k / count);
  return angles;
}

/// The integral of `intensity` over the sphere by 4 x 4 points of Gauss and Legendre in each cell of the
/// table: they are exact in C, and in gamma to 1e-10 in cells of 30 degrees.
double quadrature(const IntensityTable& table) {
  constexpr std::array<double, 4> x{-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                    0.8611363115940526};
  constexpr std::array<double, 4> w{0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                    0.3478548451374538};
  const std::vector<double> C = table.C.size() == 1 ? std::vector<double>{0, 2 * kPi} : table.C;
  double sum = 0;
  for (std::size_t c = 0; c + 1 < C.size(); ++c) {
    for (std::size_t g = 0; g + 1 < table.gamma.size(); ++g) {
      const double half_C = (C[c + 1] - C[c]) / 2, half = (table.gamma[g + 1] - table.gamma[g]) / 2;
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t k = 0; k < 4; ++k) {
          const double gamma = table.gamma[g] + half * (1 + x[k]);
          sum += w[i] * w[k] * half_C * half * std::sin(gamma) *
                 intensity(table, C[c] + half_C * (1 + x[i]), gamma);
        }
      }
    }
  }
  return sum;
}

TEST(IntensityTable, IsBilinearBetweenItsAngles) {
  const IntensityTable table = make_table({0, 90, 180, 270, 360}, {0, 60, 90}, [](double C, double gamma) {
    return gamma == 0 ? 100 : gamma == 60 ? 10 + (C == 360 ? 0 : C) / 90 : 4.0;
  });
  EXPECT_DOUBLE_EQ(intensity(table, 0, 0), 100);
  EXPECT_DOUBLE_EQ(intensity(table, radians(90), radians(60)), 11);
  EXPECT_NEAR(intensity(table, radians(45), radians(60)), 10.5, 1e-12);
  EXPECT_NEAR(intensity(table, radians(45), radians(30)), (100 + 10.5) / 2, 1e-12);
  EXPECT_NEAR(intensity(table, radians(315), radians(75)), (11.5 + 4) / 2, 1e-12);
  EXPECT_DOUBLE_EQ(intensity(table, 1, radians(90)), 4);
}

TEST(IntensityTable, IsPeriodicInC) {
  const IntensityTable table = make_table({0, 120, 240, 360}, {0, 180}, [](double C, double) {
    return C == 120 ? 6 : C == 240 ? 12 : 0;
  });
  for (const double C : {-3000.0, -350.0, -1e-300, 0.0, 10.0, 130.0, 359.0, 360.0, 370.0, 4000.0}) {
    const double within = C - 360 * std::floor(C / 360);
    const double expected = within < 120   ? within / 20
                            : within < 240 ? 6 + (within - 120) / 20
                                           : 12 - (within - 240) / 10;
    EXPECT_NEAR(intensity(table, radians(C), 1), expected, 1e-10) << C;
  }
}

TEST(IntensityTable, GivesNothingBeyondItsAngles) {
  const IntensityTable table = make_table({0}, {10, 90}, [](double, double) { return 5; });
  EXPECT_EQ(intensity(table, 0, radians(9)), 0);
  EXPECT_EQ(intensity(table, 0, radians(10)), 5);
  EXPECT_EQ(intensity(table, 0, kPi / 2), 5);
  EXPECT_EQ(intensity(table, 0, radians(90.001)), 0);
  EXPECT_EQ(intensity(table, 0, std::nan("")), 0);
}

TEST(IntensityTable, FluxOfConstantIntensityIsThatOfTheSphere) {
  const auto constant = [](double, double) { return 7; };
  EXPECT_NEAR(flux(make_table({0}, {0, 180}, constant)), 28 * kPi, 1e-13 * 28 * kPi);
  EXPECT_NEAR(flux(make_table({0, 17, 360}, {0, 1, 100, 180}, constant)), 28 * kPi, 1e-13 * 28 * kPi);
}

// A flat Lambertian source has I0 cos(gamma) and pi I0. Linear between angles h apart, it is less by h^2 / 8
// I'' at most, which is h^2 / 12 of it in the mean.
TEST(IntensityTable, FluxOfALambertianSourceIsPi) {
  const IntensityTable table =
      make_table({0}, steps(0, 90, 180), [](double, double gamma) { return std::cos(radians(gamma)); });
  const double h = radians(0.5);
  EXPECT_NEAR(flux(table), kPi * (1 - h * h / 12), 1e-4 * h * h);
}

// Of 1 - gamma / w, with small angles: pi w^2 / 3.
TEST(IntensityTable, FluxOfANarrowBeamKeepsItsDigits) {
  IntensityTable table{{0}, {0, 1e-7}, {1, 0}};
  EXPECT_NEAR(flux(table), kPi * 1e-14 / 3, 1e-12 * 1e-14);
  table.gamma[1] = 1e-2;
  EXPECT_NEAR(flux(table), kPi * 1e-4 / 3, 1e-4 * 1e-4);
}

// From above and below the angle where the closed form becomes a series.
TEST(IntensityTable, FluxIsTheIntegralOfTheInterpolatedIntensity) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> value(0, 100);
  const auto any = [&](double, double) { return value(random); };
  for (const double step : {2.0, 11.0, 12.0, 30.0}) {
    IntensityTable table = make_table({0, 5, 90, 91, 200, 360}, steps(3, 3 + 5 * step, 5), any);
    EXPECT_NEAR(flux(table) / quadrature(table), 1, 1e-10) << step;
    table = make_table({0}, steps(0, 6 * step, 6), any);
    EXPECT_NEAR(flux(table) / quadrature(table), 1, 1e-10) << step;
  }
}

TEST(IntensityTable, KnowsItsLargestIntensity) {
  EXPECT_EQ(largest_intensity({{0}, {0, 1, 2}, {3, 9, 4}}), 9);
}

}  // namespace
}  // namespace fluxel::intensity_table_test
