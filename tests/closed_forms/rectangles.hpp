#pragma once

namespace fluxel::closed_forms {

/// An axis-parallel rectangle [u_low, u_high] x [v_low, v_high] in its own plane.
struct Rectangle {
  double u_low = 0, u_high = 0, v_low = 0, v_high = 0;
};

inline constexpr Rectangle kUnitSquare{0, 1, 0, 1};

[[nodiscard]] double area(const Rectangle& rectangle);

/// F12 of two identical, directly opposed rectangles a x b at distance `gap` (Howell's catalogue, C-11).
/// Valid for all positive arguments. The textbook form cancels for sides far smaller than the gap: its terms
/// are 1, its sum (ab/gap^2)^2. Below half a gap the shorter side is therefore left as an integral of
/// positive terms,
///   F12 = 2/(pi Y) int_0^Y (Y - y) atan(X / s) / s^3 dy,  s^2 = 1 + y^2,  X = a/gap, Y = b/gap,
/// exact to rounding by a Gauss rule.
[[nodiscard]] double opposed_rectangles(double a, double b, double gap);

/// F12 of two rectangles at right angles with a common edge of length `edge`; rectangle 1 reaches `width`
/// away from it, rectangle 2 `height` (Howell's catalogue, C-14). Valid for all positive arguments; the
/// absolute error is about 1e-16 edge/width, so where height << width ask for F21 and use reciprocity.
[[nodiscard]] double adjacent_rectangles(double width, double height, double edge);

/// F12 of two parallel rectangles with parallel edges at any offset, facing each other at distance `gap` > 0:
/// `sender` = [x] x [y] at z = 0, `receiver` = [x] x [y] at z = gap (Howell's catalogue, C-13; a sum of 16
/// terms of the twice integrated kernel). The absolute error is about 1e-16 (extent^2 + gap^2) /
/// area(sender): digits are lost where the rectangles are small for their distance.
[[nodiscard]] double parallel_rectangles(const Rectangle& sender, const Rectangle& receiver, double gap);

/// F12 of two rectangles at right angles at any offset (Howell's catalogue, C-15; a sum of 16 terms):
/// `sender` = [x] x [y] in the plane z = 0 with x >= 0, facing +z; `receiver` = [z] x [y] in the plane x = 0
/// with z >= 0, facing +x. They may touch in an edge or in a corner. Absolute error as of
/// parallel_rectangles.
[[nodiscard]] double perpendicular_rectangles(const Rectangle& sender, const Rectangle& receiver);

}  // namespace fluxel::closed_forms
