#pragma once

#include "tests/closed_forms/rectangles.hpp"

namespace fluxel::closed_forms {

/// Configuration factors: the fraction of the power of a small plane piece dA that reaches a surface. The
/// same number is the irradiance at dA by a surface of unit exitance. All keep full precision but for
/// differences of corner terms, whose absolute error is 1e-16.

/// dA at the origin facing +z; the rectangle [x] x [y] at z = gap > 0 faces it, at any offset (Howell's
/// catalogue, B-3, which has one corner above dA; signed corner terms give the rest).
[[nodiscard]] double point_to_parallel_rectangle(const Rectangle& receiver, double gap);

/// dA on the x axis at `distance` > 0, facing +z; the rectangle [z] x [y] in the plane x = 0 with z >= 0
/// (Howell's catalogue, B-4, which has its foot at y = 0, z = 0; signed terms give the rest).
[[nodiscard]] double point_to_perpendicular_rectangle(double distance, const Rectangle& receiver);

/// dA faces the centre of a disc, coaxial and parallel, at distance `gap`: r^2 / (gap^2 + r^2).
[[nodiscard]] double point_to_coaxial_disc(double radius, double gap);

}  // namespace fluxel::closed_forms
