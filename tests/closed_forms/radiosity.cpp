#include "tests/closed_forms/radiosity.hpp"

#include <cmath>
#include <numbers>

#include "tests/closed_forms/rectangles.hpp"

namespace fluxel::closed_forms {

double furnace(double E, double rho, double row_sum_error) { return E / (1 - rho * (1 + row_sum_error)); }

double sphere_interior_irradiance(double mean_E, double mean_rho) { return mean_E / (1 - mean_rho); }

double integrating_sphere_irradiance(double flux, double area, double rho, double port_fraction) {
  return flux * rho / (area * (1 - rho * (1 - port_fraction)));
}

double interreflected_irradiance(double flux, double area, double rho) {
  return flux * rho / (area * (1 - rho));
}

double point_source_irradiance(double flux, double height, double offset) {
  const double distance = std::hypot(height, offset);
  return flux / (4 * std::numbers::pi) * height / (distance * distance * distance);
}

PairOfRadiosities two_elements(const Surface& surface_1, const Surface& surface_2, double F12, double F21) {
  const double loop = 1 - surface_1.rho * surface_2.rho * F12 * F21;
  return {.B1 = (surface_1.E + surface_1.rho * F12 * surface_2.E) / loop,
          .B2 = (surface_2.E + surface_2.rho * F21 * surface_1.E) / loop};
}

PairOfRadiosities concentric_spheres_radiosity(const Surface& inner, const Surface& outer, double F21) {
  const double B2 =
      (outer.E + outer.rho * F21 * inner.E) / (1 - outer.rho * (1 - F21) - inner.rho * outer.rho * F21);
  return {.B1 = inner.E + inner.rho * B2, .B2 = B2};
}

CubeWalls cube_of_six_elements(double rho) {
  // By symmetry: the difference and the sum of the emitter and its opposite, and the sum over all walls.
  const double F_opposite = opposed_rectangles(1, 1, 1), F_adjacent = adjacent_rectangles(1, 1, 1);
  const double all = 1 / (1 - rho);
  const double difference = 1 / (1 + rho * F_opposite);
  const double sum = (1 + 2 * rho * F_adjacent * all) / (1 - rho * F_opposite + 2 * rho * F_adjacent);
  return {.emitter = (sum + difference) / 2, .opposite = (sum - difference) / 2, .side = (all - sum) / 4};
}

}  // namespace fluxel::closed_forms
