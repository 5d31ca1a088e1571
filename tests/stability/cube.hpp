#pragma once

#include "solver/iterate.hpp"
#include "solver/row_operator.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {

/// The inside of a unit cube with n x n square elements a wall, n a power of two, with all its visibility.
/// Elements of the floor come first, then those of the ceiling, then the four side walls.
struct Cube {
  Scene scene = test_scenes::unit_cube();
  std::vector<Element> elements;
  TileStore store;
  Unknowns unknowns;  ///< to be filled with reflectances and emissions
  Corrections none;

  explicit Cube(int n)
      : elements(test_scenes::uniform_elements(scene, 1.0 / n).elements),
        store(test_scenes::traced(RayScene(scene, 1), elements)),
        unknowns(make_unknowns(elements, scene.materials)) {}

  [[nodiscard]] std::size_t elements_of_wall() const { return elements.size() / 6; }

  /// rho random up to rho_max and E = 1 - rho, so that B = 1 is the solution where row sums are 1.
  void make_furnace(double rho_max, unsigned seed) {
    std::mt19937 random(seed);
    for (std::size_t i = 0; i < elements.size(); ++i) {
      unknowns.rho[i] = Rgb(test_scenes::uniform(random, 0, rho_max));
      unknowns.E[i] = Rgb(1) - unknowns.rho[i];
    }
  }

  /// One reflectance everywhere, exitance 1 of the floor alone.
  void light_the_floor(double rho) {
    for (std::size_t i = 0; i < elements.size(); ++i) {
      unknowns.rho[i] = Rgb(rho);
      unknowns.E[i] = Rgb(i < elements_of_wall() ? 1 : 0);
    }
  }

  [[nodiscard]] RowSums row_sums(PairRule rule) const {
    RowOperator F(elements, store, none, rule, false, 1);
    return find_error_weights(F, unknowns);
  }

  [[nodiscard]] Radiosity solve(PairRule rule, Solver solver, const StopRule& stop) const {
    RowOperator F(elements, store, none, rule, false, 1);
    return solve_radiosity(solver, F, unknowns, find_error_weights(F, unknowns), stop, [](int, double) {});
  }

  /// The area average of B over walls [first, last).
  [[nodiscard]] double wall_average(const Radiosity& result, std::size_t first, std::size_t last) const {
    double sum = 0;
    for (std::size_t i = first * elements_of_wall(); i < last * elements_of_wall(); ++i) sum += result.B[i].r;
    return sum / static_cast<double>((last - first) * elements_of_wall());
  }
};

}  // namespace fluxel
