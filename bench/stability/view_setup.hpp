#pragma once

#include <span>

#include "bench/stability/lab.hpp"
#include "tests/closed_forms/polygons.hpp"

namespace fluxel::lab {

/// Two black polygons, of which the first emits 1 W/m2, and black blockers between them.
struct View {
  closed_forms::Polygon sender, receiver;
  std::vector<closed_forms::Polygon> blockers;
  double max_edge = 0;  ///< of the elements [m]; 0: an element a polygon
};

/// The view factor from sender to receiver that the power received says, against the exact one; relative.
[[nodiscard]] Measurement measure_view(const Communicator& world, const Method& method, const View& view,
                                       double exact);

/// The inside of a unit cube with n x n elements a wall, the groups "floor", "ceiling" and "sides"; `rho` is
/// everywhere, `floor_E` and `other_E` [W/m2] are emitted.
[[nodiscard]] Setup unit_cube(int n, double rho, double floor_E, double other_E);

/// The same cube as a furnace: rho random up to rho_max for each element and E = 1 - rho, so that B = 1 is
/// exact where all row sums are 1.
[[nodiscard]] Setup unit_furnace(int n, double rho_max, unsigned seed);

/// The largest relative error of the averages of B over the floor, the ceiling and the sides of a unit cube
/// whose floor alone emits 1 W/m2, against the continuous solution. Throws std::out_of_range for a
/// reflectance for which that is not known.
[[nodiscard]] Measurement measure_wall_averages(const Run& run, double rho);

}  // namespace fluxel::lab
