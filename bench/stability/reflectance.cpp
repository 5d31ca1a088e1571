#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/stability/rooms.hpp"
#include "bench/stability/situation_lists.hpp"
#include "bench/stability/view_setup.hpp"

namespace fluxel::lab {

namespace {

constexpr int kRoomElements = 8;  // along an edge

double diverged_or(const Run& run, double error) {
  return run.radiosity.converged ? error : std::numeric_limits<double>::infinity();
}

double largest_row_sum_error(const Run& run) {
  double largest = 0;
  for (const double sum : run.row_sums) largest = std::max(largest, std::abs(sum - 1));
  return largest;
}

Measurement measure_furnace(const Communicator& world, const Method& method, double absorbed) {
  const Run done = run(world, unit_furnace(kRoomElements, 1 - absorbed, 1), method);
  return {diverged_or(done, furnace_error(done)), done.radiosity.converged};
}

/// The mean of B over all walls is 1/6 / (1 - rho) whatever the refinement: light is neither lost nor made.
Measurement measure_bright_room(const Communicator& world, const Method& method, double absorbed) {
  Setup setup = unit_cube(kRoomElements, 1 - absorbed, 1, 0);
  // Single precision leaves an uncertainty of about 1e-6 / absorbed, relative.
  setup.stop = {std::min(1e-2, 5e-6 / absorbed), 400000};
  const Run done = run(world, setup, method);
  const double mean = area_mean(done.unknowns, done.radiosity.B).r;
  return {diverged_or(done, std::abs(6 * mean * absorbed - 1)), done.radiosity.converged};
}

Measurement measure_row_sums(const Communicator& world, const Method& method, double n) {
  const Run done = run(world, unit_cube(static_cast<int>(n), 0.5, 1, 1), method);
  return {largest_row_sum_error(done), true};
}

template <int kPercent>
Measurement measure_emitting_wall(const Communicator& world, const Method& method, double n) {
  constexpr double kRho = kPercent / 100.0;
  return measure_wall_averages(run(world, unit_cube(static_cast<int>(n), kRho, 1, 0), method), kRho);
}

}  // namespace

std::vector<Situation> reflectance_situations() {
  const std::vector<double> absorbed{0.5, 0.2, 0.1, 0.05, 0.01, 0.001, 0.0001};
  return {{.name = "row-sums",
           .title = "Row sums in a closed cube",
           .parameter = "elements along an edge",
           .error = "largest |row sum - 1|",
           .threshold = 1e-3,
           .values = {1, 2, 4, 8, 16},
           .coarse_values = {1, 4, 8},
           .measure = measure_row_sums},
          {.name = "furnace",
           .title = "Furnace, 8 x 8 elements a wall, reflectances at random",
           .parameter = "1 - largest reflectance",
           .error = "largest |B - 1|",
           .threshold = 1e-3,
           .values = absorbed,
           .coarse_values = {0.5, 0.1},
           .measure = measure_furnace},
          {.name = "bright-room",
           .title = "Cube with one emitting wall, 8 x 8 elements a wall, one reflectance",
           .parameter = "1 - reflectance",
           .error = "relative error of the mean of B",
           .threshold = 1e-2,
           .values = absorbed,
           .coarse_values = {0.5, 0.1, 0.01},
           .measure = measure_bright_room},
          {.name = "emitting-wall",
           .title = "Cube with one emitting wall, reflectance 0.5",
           .parameter = "elements along an edge",
           .error = "largest relative error of a wall's mean of B",
           .threshold = 2e-3,
           .values = {2, 4, 8, 16, 32},
           .coarse_values = {8},
           .measure = measure_emitting_wall<50>},
          {.name = "emitting-wall-bright",
           .title = "Cube with one emitting wall, reflectance 0.9",
           .parameter = "elements along an edge",
           .error = "largest relative error of a wall's mean of B",
           .threshold = 2e-3,
           .values = {2, 4, 8, 16, 32},
           .coarse_values = {8},
           .measure = measure_emitting_wall<90>}};
}

}  // namespace fluxel::lab
