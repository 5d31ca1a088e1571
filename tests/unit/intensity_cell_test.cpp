#include "optics/intensity_cell.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace fluxel {
namespace {

constexpr double kPi = std::numbers::pi;

/// A table of one cell: intensities at the first gamma, then at the second, each at both planes.
IntensityTable one_cell(double gamma_1, double gamma_2, double C_1, double C_2, double A_1, double A_2,
                        double B_1, double B_2) {
  return {{C_1, C_2}, {gamma_1, gamma_2}, {A_1, B_1, A_2, B_2}};
}

std::vector<IntensityTable> cells() {
  return {one_cell(0.2, 0.7, 0.5, 1.1, 3, 5, 2, 9),       one_cell(0, kPi, 0, 2 * kPi, 1, 1, 1, 1),
          one_cell(0, 0.02, 0, 0.1, 4, 0, 0, 1),          one_cell(kPi / 2, kPi, 1, 4, 0, 0, 7, 0),
          one_cell(kPi - 1e-3, kPi, 0, 6, 1, 2, 3, 4),    one_cell(1, 1 + 1e-6, 2, 2.5, 10, 0, 0, 0),
          one_cell(0.3, 2.9, 0, 2 * kPi, 0, 1e-9, 1e3, 0)};
}

/// The integral of f times the intensity over the cell's solid angle, by the rule of midpoints.
template <class Function>
double integral(const IntensityTable& of, double gamma_end, int steps, const Function& f) {
  double sum = 0;
  const double d_gamma = (gamma_end - of.gamma[0]) / steps, d_C = (of.C[1] - of.C[0]) / steps;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const double s = (j + 0.5) / steps, gamma = of.gamma[0] + (i + 0.5) * d_gamma;
      const double t = (gamma - of.gamma[0]) / (of.gamma[1] - of.gamma[0]);
      const double I =
          std::lerp(std::lerp(of.at(0, 0), of.at(1, 0), s), std::lerp(of.at(0, 1), of.at(1, 1), s), t);
      sum += f(of.C[0] + s * (of.C[1] - of.C[0]), gamma) * I * std::sin(gamma) * d_gamma * d_C;
    }
  return sum;
}

TEST(IntensityCell, FluxIsTheIntegral) {
  for (const IntensityTable& table : cells()) {
    const double flux = IntensityCell(table, 0, 0).flux();
    EXPECT_NEAR(integral(table, table.gamma[1], 400, [](double, double) { return 1.0; }) / flux, 1, 1e-5);
  }
}

// The share of the flux below an angle is the number that gave it.
TEST(IntensityCell, GammaIsTheInverseOfTheFluxBelow) {
  for (const IntensityTable& table : cells()) {
    const IntensityCell cell(table, 0, 0);
    double before = table.gamma[0];
    for (const double u : {0.0, 1e-12, 1e-3, 0.1, 0.37, 0.5, 0.9, 0.999, 1 - 1e-12}) {
      const double gamma = cell.direction(u, 0.5).gamma;
      ASSERT_GE(gamma, before);
      ASSERT_LE(gamma, table.gamma[1]);
      const double share = integral(table, gamma, 300, [](double, double) { return 1.0; }) / cell.flux();
      EXPECT_NEAR(share, u, 3e-5);
      before = gamma;
    }
  }
}

TEST(IntensityCell, DirectionsAreAsOftenAsTheIntensitySays) {
  constexpr int kStrata = 300;
  for (const IntensityTable& table : cells()) {
    const IntensityCell cell(table, 0, 0);
    const auto place = [&](double C, double gamma) {
      return std::array{(C - table.C[0]) / (table.C[1] - table.C[0]),
                        (gamma - table.gamma[0]) / (table.gamma[1] - table.gamma[0])};
    };
    std::array<double, 4> drawn{}, exact{};
    const auto moments = [&](double C, double gamma) {
      const auto [s, t] = place(C, gamma);
      return std::array{s, t, s * t, s * s * t * t};
    };
    for (int i = 0; i < kStrata; ++i)
      for (int j = 0; j < kStrata; ++j) {
        const auto [C, gamma] = cell.direction((i + 0.5) / kStrata, (j + 0.5) / kStrata);
        ASSERT_GE(C, table.C[0]);
        ASSERT_LE(C, table.C[1]);
        const auto found = moments(C, gamma);
        for (std::size_t k = 0; k < 4; ++k) drawn[k] += found[k] / (kStrata * kStrata);
      }
    for (std::size_t k = 0; k < 4; ++k)
      exact[k] = integral(table, table.gamma[1], kStrata,
                          [&](double C, double gamma) { return moments(C, gamma)[k]; }) /
                 cell.flux();
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(drawn[k], exact[k], 1e-4) << k;
  }
}

TEST(IntensityCell, CellsAddUpToTheTable) {
  IntensityTable table;
  for (int k = 0; k <= 8; ++k) table.C.push_back(k * kPi / 4);
  for (int k = 0; k <= 18; ++k) table.gamma.push_back(k * kPi / 18);
  for (int c = 0; c <= 8; ++c)
    for (int g = 0; g <= 18; ++g) table.intensity.push_back(g < 10 ? 3 + c % 8 + g * g : 0);
  double sum = 0;
  for (std::size_t c = 0; c < 8; ++c)
    for (std::size_t g = 0; g < 18; ++g) sum += IntensityCell(table, c, g).flux();
  EXPECT_NEAR(sum / flux(table), 1, 1e-12);
}

}  // namespace
}  // namespace fluxel
