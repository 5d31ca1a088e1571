#include "tests/closed_forms/radiosity.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/closed_forms/curved.hpp"
#include "tests/closed_forms/rectangles.hpp"

namespace fluxel::closed_forms {
namespace {

/// B = E + rho F B by Gauss-Seidel sweeps.
std::vector<double> solve(const std::vector<std::vector<double>>& F, const std::vector<double>& rho,
                          const std::vector<double>& E) {
  std::vector<double> B = E;
  for (int sweep = 0; sweep < 5000; ++sweep) {
    for (std::size_t i = 0; i < B.size(); ++i) {
      double H = 0;
      for (std::size_t j = 0; j < B.size(); ++j) H += F[i][j] * B[j];
      B[i] = E[i] + rho[i] * H;
    }
  }
  return B;
}

TEST(Radiosity, Furnace) {
  EXPECT_NEAR(furnace(2, 0.75), 8, 1e-14);
  EXPECT_NEAR(furnace(1, 0.99, 1e-3), 110.99, 5e-3);
  const std::vector<double> rho{0.1, 0.9, 0.5};
  for (const double B : solve({{0, 0.3, 0.7}, {0.6, 0, 0.4}, {0.5, 0.5, 0}}, rho, {0.9, 0.1, 0.5})) {
    EXPECT_NEAR(B, 1, 1e-14);
  }
}

TEST(Radiosity, SphereInterior) {
  // A cap of 1 % of the area emits.
  const double H = sphere_interior_irradiance(0.01, 0.9);
  EXPECT_NEAR(1 + 0.9 * H, 1.09, 1e-14);
  EXPECT_NEAR(0.9 * H, 0.09, 1e-14);
  // Three zones of unequal E and rho: F_ij is the share of zone j.
  const std::vector<double> share{0.2, 0.5, 0.3}, rho{0.8, 0.1, 0.6}, E{1, 0.2, 0};
  const std::vector<double> B = solve({share, share, share}, rho, E);
  const double uneven = sphere_interior_irradiance(0.2 + 0.1, 0.16 + 0.05 + 0.18);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(B[i], E[i] + rho[i] * uneven, 1e-14);
}

TEST(Radiosity, IntegratingSphere) {
  // The port as a black zone; the source's first reflection is the wall's E.
  const double flux = 7, area = 3, rho = 0.95, port = 0.02;
  const std::vector<double> share{1 - port, port};
  const std::vector<double> B = solve({share, share}, {rho, 0}, {rho * flux / (area * (1 - port)), 0});
  EXPECT_NEAR(integrating_sphere_irradiance(flux, area, rho, port), B[0] * (1 - port), 1e-12);
}

TEST(Radiosity, TwoElements) {
  const Surface first{.E = 1, .rho = 0.7}, second{.E = 0.3, .rho = 0.4};
  const auto [B1, B2] = two_elements(first, second, 0.2, 0.1);
  const std::vector<double> B = solve({{0, 0.2}, {0.1, 0}}, {0.7, 0.4}, {1, 0.3});
  EXPECT_NEAR(B1, B[0], 1e-14);
  EXPECT_NEAR(B2, B[1], 1e-14);
  EXPECT_NEAR(two_elements(first, second, 1, 1).B1, (1 + 0.7 * 0.3) / (1 - 0.28), 1e-14);  // infinite plates
}

TEST(Radiosity, ConcentricSpheres) {
  const double F21 = concentric_spheres(1, 3).outer_to_inner;
  const auto [B1, B2] = concentric_spheres_radiosity({.E = 1, .rho = 0.5}, {.E = 0.2, .rho = 0.9}, F21);
  const std::vector<double> B = solve({{0, 1}, {F21, 1 - F21}}, {0.5, 0.9}, {1, 0.2});
  EXPECT_NEAR(B1, B[0], 1e-13);
  EXPECT_NEAR(B2, B[1], 1e-13);
}

TEST(Radiosity, CubeOfSixElements) {
  struct Row {
    double rho;
    CubeWalls walls;
  };
  for (const auto& [rho, expected] : {Row{0.5, {1.0909090981, 0.1817458261, 0.1818362689}},
                                      Row{0.9, {2.3728813748, 1.5253105511, 1.5254520185}},
                                      Row{0.99, {17.3622704726, 16.5274251277, 16.5275760999}}}) {
    const CubeWalls walls = cube_of_six_elements(rho);
    EXPECT_NEAR(walls.emitter, expected.emitter, 6e-11);
    EXPECT_NEAR(walls.opposite, expected.opposite, 6e-11);
    EXPECT_NEAR(walls.side, expected.side, 6e-11);
  }
}

TEST(Radiosity, RoomWithAPointSource) {
  const double flux = 10000, area = 96;
  EXPECT_NEAR(interreflected_irradiance(flux, area, 0.1), 11.5741, 5e-5);
  EXPECT_NEAR(interreflected_irradiance(flux, area, 0.5), 104.1667, 5e-5);
  EXPECT_NEAR(interreflected_irradiance(flux, area, 0.9), 937.5, 1e-10);
  EXPECT_NEAR(point_source_irradiance(flux, 2, 0), 198.943679, 5e-7);
  EXPECT_NEAR(point_source_irradiance(flux, 2, std::sqrt(8)), 38.286729, 5e-7);
}

/// The cube's walls in n x n equal elements with exact factors. Symmetry leaves three fields of n x n: the
/// emitter, its opposite and one side wall, whose v axis runs from the emitter to the opposite; factors
/// depend on offsets alone.
class ElementCube {
 public:
  explicit ElementCube(int n) : n_(n) {
    const auto cell = [n](int i, int j) {
      return Rectangle{.u_low = double(i) / n,
                       .u_high = double(i + 1) / n,
                       .v_low = double(j) / n,
                       .v_high = double(j + 1) / n};
    };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        opposed_.push_back(parallel_rectangles(cell(0, 0), cell(i, j), 1));
        for (int k = 0; k < n; ++k) adjacent_.push_back(perpendicular_rectangles(cell(i, 0), cell(j, k)));
      }
    }
  }

  [[nodiscard]] CubeWalls solve(double rho) const {
    const auto cells = static_cast<std::size_t>(n_ * n_);
    // The start has the solution's energy, which sweeps keep; what else is wrong falls by rho/5 or so in
    // each.
    const std::vector<double> start(cells, 1 / (6 * (1 - rho)));
    std::vector<double> emitter = start, opposite = start, side = start;
    for (int sweep = 0; sweep < 25; ++sweep) {
      std::vector<double> next_emitter, next_opposite, next_side;
      for (int u = 0; u < n_; ++u) {
        for (int v = 0; v < n_; ++v) {
          next_emitter.push_back(1 + rho * (from_opposed(opposite, u, v) + from_sides(side, u, v, false)));
          next_opposite.push_back(rho * (from_opposed(emitter, u, v) + from_sides(side, u, v, true)));
          next_side.push_back(rho * side_irradiance(emitter, opposite, side, u, v));
        }
      }
      emitter = std::move(next_emitter);
      opposite = std::move(next_opposite);
      side = std::move(next_side);
    }
    return {.emitter = mean(emitter), .opposite = mean(opposite), .side = mean(side)};
  }

 private:
  [[nodiscard]] double at(const std::vector<double>& field, int u, int v) const {
    return field[static_cast<std::size_t>(u * n_ + v)];
  }
  [[nodiscard]] double mean(const std::vector<double>& field) const {
    double sum = 0;
    for (const double value : field) sum += value;
    return sum / double(field.size());
  }
  /// By a wall's cell (i, j) at the edge distance i, to a cell at edge distance j, |k| cells along the edge.
  [[nodiscard]] double adjacent(int i, int j, int k) const {
    return adjacent_[static_cast<std::size_t>((i * n_ + j) * n_ + std::abs(k))];
  }

  [[nodiscard]] double from_opposed(const std::vector<double>& wall, int u, int v) const {
    double H = 0;
    for (int i = 0; i < n_; ++i) {
      for (int j = 0; j < n_; ++j) {
        H += opposed_[static_cast<std::size_t>(std::abs(u - i) * n_ + std::abs(v - j))] * at(wall, i, j);
      }
    }
    return H;
  }
  /// To the emitter or the opposite wall from the four side walls.
  [[nodiscard]] double from_sides(const std::vector<double>& side, int u, int v, bool far) const {
    double H = 0;
    for (int along = 0; along < n_; ++along) {
      for (int away = 0; away < n_; ++away) {
        const double factors = adjacent(u, away, v - along) + adjacent(n_ - 1 - u, away, v - along) +
                               adjacent(v, away, u - along) + adjacent(n_ - 1 - v, away, u - along);
        H += factors * at(side, along, far ? n_ - 1 - away : away);
      }
    }
    return H;
  }
  [[nodiscard]] double side_irradiance(const std::vector<double>& emitter,
                                       const std::vector<double>& opposite, const std::vector<double>& side,
                                       int u, int v) const {
    double H = from_opposed(side, u, v);
    for (int along = 0; along < n_; ++along) {
      for (int away = 0; away < n_; ++away) {
        H += adjacent(v, away, u - along) * at(emitter, along, away);
        H += adjacent(n_ - 1 - v, away, u - along) * at(opposite, along, away);
        // The neighbouring side walls share the edges that run from the emitter to the opposite.
        H += (adjacent(u, away, v - along) + adjacent(n_ - 1 - u, away, v - along)) * at(side, away, along);
      }
    }
    return H;
  }

  int n_;
  std::vector<double> opposed_, adjacent_;
};

TEST(Radiosity, ContinuousCubeIsTheLimit) {
  const std::array record{1.0909091, 1.0990158, 1.1026457, 1.1038447, 1.1042108};
  std::array<ElementCube, 5> cubes{ElementCube(1), ElementCube(2), ElementCube(4), ElementCube(8),
                                   ElementCube(16)};
  for (std::size_t i = 0; i < cubes.size(); ++i) EXPECT_NEAR(cubes[i].solve(0.5).emitter, record[i], 6e-8);

  // The limit by Aitken's rule; from 16 x 16 on it still moves by about a tenth of what it extrapolates.
  const auto limit = [](double a, double b, double c) { return c + (c - b) * (c - b) / ((b - a) - (c - b)); };
  for (const ContinuousCube& expected : kContinuousCube) {
    const CubeWalls coarse = cubes[2].solve(expected.rho), fine = cubes[3].solve(expected.rho),
                    finest = cubes[4].solve(expected.rho);
    const auto check = [&](double CubeWalls::*wall) {
      const double extrapolated = limit(coarse.*wall, fine.*wall, finest.*wall);
      EXPECT_NEAR(extrapolated, expected.mean.*wall,
                  0.1 * std::abs(extrapolated - finest.*wall) + 2 * expected.uncertainty.*wall)
          << expected.rho;
    };
    check(&CubeWalls::emitter);
    check(&CubeWalls::opposite);
    check(&CubeWalls::side);
    EXPECT_NEAR(finest.emitter + finest.opposite + 4 * finest.side, 1 / (1 - expected.rho), 1e-10);
  }
}

TEST(Radiosity, ContinuousCubeKeepsEnergy) {
  for (const auto& [rho, mean, uncertainty] : kContinuousCube) {
    EXPECT_NEAR(mean.emitter + mean.opposite + 4 * mean.side, 1 / (1 - rho),
                uncertainty.emitter + uncertainty.opposite + 4 * uncertainty.side);
  }
}

}  // namespace
}  // namespace fluxel::closed_forms
