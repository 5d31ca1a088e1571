#pragma once

/// View factors and radiosities known exactly, for tests and benches: each from its own formula, none by the
/// project's solver. F12 is the fraction of the diffuse power leaving surface 1 that reaches surface 2, so
/// A1 F12 = A2 F21. Lengths are in any one unit. Preconditions stand in each docstring and are not checked.

#include "tests/closed_forms/curved.hpp"      // IWYU pragma: export
#include "tests/closed_forms/occluded.hpp"    // IWYU pragma: export
#include "tests/closed_forms/points.hpp"      // IWYU pragma: export
#include "tests/closed_forms/polygons.hpp"    // IWYU pragma: export
#include "tests/closed_forms/radiosity.hpp"   // IWYU pragma: export
#include "tests/closed_forms/rectangles.hpp"  // IWYU pragma: export
