#pragma once

#include <array>

namespace fluxel::closed_forms {

/// Exact solutions of B = E + rho F B. E exitance, rho reflectance, B radiosity.

/// White furnace: any closed room, any visibility, equal E and rho: B = E / (1 - rho). If every row sum of F
/// is wrong by `row_sum_error`, relative, the discrete solution is E / (1 - rho (1 + row_sum_error)). With
/// rho different everywhere, E = 1 - rho gives B = 1.
[[nodiscard]] double furnace(double E, double rho, double row_sum_error = 0);

/// Inside a sphere F_ij = A_j / A: the irradiance is mean_E / (1 - mean_rho) at every point, for any E and
/// rho over it, and B = E + rho times it. Means by area.
[[nodiscard]] double sphere_interior_irradiance(double mean_E, double mean_rho);

/// Integrating sphere with ports: mean indirect irradiance of the sphere of `area`, ports included, that
/// covers `port_fraction` with black ports and has `rho` elsewhere, when the source's `flux` first falls on
/// wall alone.
[[nodiscard]] double integrating_sphere_irradiance(double flux, double area, double rho,
                                                   double port_fraction);

/// Indirect irradiance, mean by area, of a closed room of total surface `area` and equal rho, whose sources
/// emit `flux`: flux rho / (area (1 - rho)) (CIE 171:2006, 5.8). The direct mean is flux / area.
[[nodiscard]] double interreflected_irradiance(double flux, double area, double rho);

/// Irradiance by an isotropic point source of `flux` at `height` above the surface and `offset` beside the
/// point.
[[nodiscard]] double point_source_irradiance(double flux, double height, double offset);

/// Two surfaces, each of equal B.
struct Surface {
  double E = 0, rho = 0;
};
struct PairOfRadiosities {
  double B1 = 0, B2 = 0;
};

/// Two plane or convex surfaces in black surroundings, each taken as one element of constant B.
/// F12 = F21 = 1 gives infinite parallel plates, for which it is exact at every point.
[[nodiscard]] PairOfRadiosities two_elements(const Surface& surface_1, const Surface& surface_2, double F12,
                                             double F21);

/// Concentric spheres, 1 the inner, F21 = (r1/r2)^2. Exact at every point, and the outer sphere sees itself
/// past the inner one.
[[nodiscard]] PairOfRadiosities concentric_spheres_radiosity(const Surface& inner, const Surface& outer,
                                                             double F21);

/// A unit cube, E = 1 on one wall, equal rho.
struct CubeWalls {
  double emitter = 0, opposite = 0, side = 0;
};

/// Six elements of constant B, one a wall. Not the limit of refinement: that is kContinuousCube.
[[nodiscard]] CubeWalls cube_of_six_elements(double rho);

/// Area means over the walls of the continuous solution, with their uncertainty: limits by Aitken's rule of n
/// x n constant elements a wall with exact form factors, n = 2..64. emitter + opposite + 4 side = 1 / (1 -
/// rho).
struct ContinuousCube {
  double rho;
  CubeWalls mean, uncertainty;
};
inline constexpr std::array kContinuousCube{
    ContinuousCube{.rho = 0.5, .mean = {1.104362, 0.171216, 0.181105}, .uncertainty = {2e-6, 1e-6, 1e-6}},
    ContinuousCube{.rho = 0.9, .mean = {2.419372, 1.487885, 1.523185}, .uncertainty = {6e-6, 3e-6, 2e-6}},
    ContinuousCube{.rho = 0.99, .mean = {17.42029, 16.48034, 16.52484}, .uncertainty = {1e-5, 1e-5, 1e-5}},
};

/// The same solution at the centres of the emitting and of the opposite wall.
struct ContinuousCubeCentres {
  double rho, emitter, opposite, uncertainty;
};
inline constexpr std::array kContinuousCubeCentres{
    ContinuousCubeCentres{.rho = 0.5, .emitter = 1.091805, .opposite = 0.197604, .uncertainty = 2e-6},
    ContinuousCubeCentres{.rho = 0.9, .emitter = 2.37275, .opposite = 1.55151, .uncertainty = 1e-5},
};

}  // namespace fluxel::closed_forms
