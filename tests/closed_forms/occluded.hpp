#pragma once

#include <span>

#include "tests/closed_forms/rectangles.hpp"

namespace fluxel::closed_forms {

/// Taut strings of a plane section: the sums of the lengths of both crossed and of both uncrossed strings.
struct Strings {
  double crossed = 0, uncrossed = 0;
};

/// F12 of two infinitely long surfaces, what stands between them included (Hottel 1954): half the difference
/// of the taut strings' lengths by the length of surface 1 in the section. Exact.
[[nodiscard]] double crossed_strings(const Strings& strings, double sender_length);

/// An infinitely long corridor that turns by a right angle: outer walls of length `arm` along x and along y
/// from the origin, both arms `width` wide. F from one outer wall to the other past the inner corner (width,
/// width), by crossed strings. The corner hides something where 2 width < arm; needs 0 < width <= arm.
[[nodiscard]] double l_corridor(double arm, double width);

/// The same corridor `height` high with both ends of the walls free: F from one outer wall, arm x height, to
/// the other past an inner corner that reaches over the full height. The geometry of Pinney & Bean's fourth
/// test of view factors between rooms' surfaces: from distance c along a wall, the first V(c) = min(arm,
/// width c / (c - width)) of the other is visible. The integral over c and both heights is closed but for the
/// hidden part's last one, which is smooth; precise to 1e-14. height -> infinity gives l_corridor.
[[nodiscard]] double l_room(double arm, double width, double height);

/// Two unit squares [0,1]^2 at z = 0 and z = 1 face each other; opaque axis-parallel rectangles stand in the
/// plane z = 1/2, apart from or touching each other. F12 of what still passes. A blocker's shadow from a
/// point p of the sender is the rectangle 2 blocker - p, so that F lost at p is closed (B-3); the Gauss rule
/// over p is broken where a shadow's edge meets the receiver's. Precise to 1e-14 for each blocker.
[[nodiscard]] double opposed_squares_past(std::span<const Rectangle> blockers);

/// The centred square blocker of that kind.
[[nodiscard]] Rectangle centred_blocker(double side);

}  // namespace fluxel::closed_forms
