#include <cmath>
#include <numbers>

#include "bench/stability/situation_lists.hpp"
#include "bench/stability/view_setup.hpp"

namespace fluxel::lab {

namespace {

constexpr double kRho = 0.5;

/// The camera stands in the middle of the cube; the floor, which sends, is what it sees least of when it
/// looks up. What it does not see stays as coarse as `max_edge` [m] lets it.
Setup seen_cube(double degrees_up, double max_edge) {
  constexpr int kPixels = 24;
  Setup setup = unit_cube(1, kRho, 1, 0);
  const double angle = degrees_up * std::numbers::pi / 180;
  Camera camera;
  camera.eye = {0, 0, 0};
  camera.look_at = {std::cos(angle), 0, std::sin(angle)};
  camera.up = {-std::sin(angle), 0, std::cos(angle)};
  camera.fov = 60;
  camera.width = camera.height = kPixels;
  setup.camera = camera;
  setup.subdivision = Subdivision::camera;
  setup.max_edge = max_edge;
  return setup;
}

Measurement measure_direction(const Communicator& world, const Method& method, double degrees_up) {
  constexpr double kUnseenEdge = 0.25;
  return measure_wall_averages(run(world, seen_cube(degrees_up, kUnseenEdge), method), kRho);
}

Measurement measure_unseen_edge(const Communicator& world, const Method& method, double max_edge) {
  constexpr double kUp = 90;
  return measure_wall_averages(run(world, seen_cube(kUp, max_edge), method), kRho);
}

}  // namespace

std::vector<Situation> camera_situations() {
  const std::string error = "largest relative error of a wall's mean of B";
  return {{.name = "camera-direction",
           .title = "A camera turned from the emitting floor to the ceiling; elements out of sight up to 1/4",
           .parameter = "direction of view above the horizon [degrees]",
           .error = error,
           .threshold = 0.01,
           .log_parameter = false,
           .values = {-90, -60, -30, 0, 30, 60, 90},
           .coarse_values = {-90, 0, 90},
           .measure = measure_direction},
          {.name = "camera-unseen",
           .title = "A camera that turns its back on the emitting floor",
           .parameter = "largest edge out of sight [sides]",
           .error = error,
           .threshold = 0.01,
           .values = {1, 0.5, 0.25, 0.125, 0.0625},
           .coarse_values = {0.25},
           .measure = measure_unseen_edge}};
}

}  // namespace fluxel::lab
