#pragma once

#include "bench/stability/lab.hpp"

/// Closed rooms with small lamps, as solvers meet them: one-sided, every unknown with a row sum near 1.
namespace fluxel::lab {

enum class LitRoom {
  box,        ///< convex: 4 x 4 x 3 m
  cluttered,  ///< 10 x 8 x 3 m with 12 boxes that float
  two_rooms   ///< two of 4 x 4 x 3 m, joined by a door of 0.4 x 0.8 m in a wall of 0.2 m
};

/// In the ceiling (of the first room) are the groups "lamp" and "second lamp" of 0.5 x 0.5 m, which emit
/// nothing yet; rho = 0.5 everywhere.
[[nodiscard]] Setup lit_room(LitRoom room, double max_edge);

/// The elements of the group emit E [W/m2], the others nothing.
void light(const Prepared& room, const std::string& group, const Rgb& E, Unknowns& unknowns);

void set_reflectance(double rho, Unknowns& unknowns);

/// Reflectances from `least` to `most`, random for each patch and colour; the same in every run.
void mix_reflectances(const Prepared& room, double least, double most, Unknowns& unknowns);

}  // namespace fluxel::lab
