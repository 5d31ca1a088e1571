#pragma once

namespace fluxel::closed_forms {

/// F12 of two coaxial parallel discs facing each other at distance `gap` (Howell's catalogue, C-41), for all
/// positive arguments; written so that nothing cancels.
[[nodiscard]] double coaxial_discs(double radius_1, double radius_2, double gap);

/// F12 of a sphere to a rectangle length_1 x length_2 that has a corner at the foot of the sphere's centre,
/// at distance `centre_height`; any radius below that (Feingold & Gupta 1970). A diffuse sphere radiates
/// outwards as an isotropic point, so this is the rectangle's solid angle over 4 pi.
[[nodiscard]] double sphere_to_rectangle(double length_1, double length_2, double centre_height);

/// F12 of a sphere to a coaxial disc, the centre at distance `centre_height` from it; any radius below that
/// (Feingold & Gupta 1970).
[[nodiscard]] double sphere_to_coaxial_disc(double disc_radius, double centre_height);

/// Fractions from the outer (2) of two nested surfaces to the inner (1) and back to itself.
struct NestedFactors {
  double outer_to_inner = 0, outer_to_outer = 0;
};

/// Concentric spheres: F12 = 1, F21 = (r1/r2)^2, the rest returns. Needs inner_radius < outer_radius.
[[nodiscard]] NestedFactors concentric_spheres(double inner_radius, double outer_radius);

/// Infinitely long coaxial cylinders: F12 = 1, F21 = r1/r2, the rest returns. Needs inner_radius <
/// outer_radius.
[[nodiscard]] NestedFactors infinite_coaxial_cylinders(double inner_radius, double outer_radius);

/// Coaxial cylinders of the same finite length, open at both ends (Hamilton & Morgan 1952; Howell's
/// catalogue). F12 = (r2/r1) F21; each open end receives (1 - F21 - F22)/2. Needs inner_radius <
/// outer_radius. The absolute error is about 1e-15 length/radius, for the terms that cancel in long
/// cylinders.
[[nodiscard]] NestedFactors finite_coaxial_cylinders(double inner_radius, double outer_radius, double length);

/// Any convex body inside any closed shell: F12 = 1, so the shell's mean F21 = A1/A2, and 1 - A1/A2 of its
/// power returns to the shell past the body.
[[nodiscard]] NestedFactors convex_body_in_shell(double body_area, double shell_area);

}  // namespace fluxel::closed_forms
