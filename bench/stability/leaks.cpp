#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "bench/stability/rooms.hpp"
#include "bench/stability/situation_lists.hpp"

namespace fluxel::lab {

namespace {

/// A closed L-shaped room with a re-entrant edge. All its faces are rectangles, and no edge is as long as
/// another or a half or a quarter of it: which of two equal edges is bisected is for rounding to say.
SceneInput concave_room() {
  constexpr double kLength = 2.1, kDepth = 1.9, kArm = 0.93, kStem = 0.87, kHeight = 1.13;
  SceneInput input;
  const std::vector<glm::dvec3> plan{{0, 0, 0},        {kLength, 0, 0},    {kLength, kArm, 0},
                                     {kStem, kArm, 0}, {kStem, kDepth, 0}, {0, kDepth, 0}};
  const glm::dvec3 up{0, 0, kHeight};
  for (std::size_t k = 0; k < plan.size(); ++k) {
    const glm::dvec3 &from = plan[k], &to = plan[(k + 1) % plan.size()];
    add_polygon(input, "walls", 0.5, 0, {from, from + up, to + up, to});
  }
  const auto add_level = [&](double x, double low, double high) {
    const std::vector<glm::dvec3> floor{{0, low, 0}, {x, low, 0}, {x, high, 0}, {0, high, 0}};
    add_polygon(input, "floor", 0.5, 0, floor);
    add_polygon(input, "ceiling", 0.5, 0, {floor[3] + up, floor[2] + up, floor[1] + up, floor[0] + up});
  };
  add_level(kLength, 0, kArm);
  add_level(kStem, kArm, kDepth);
  return input;
}

/// The furnace in the concave room, scaled and moved.
Run furnace(const Communicator& world, const Method& method, double scale, const glm::dvec3& shift) {
  Setup setup;
  setup.input = concave_room();
  transform(setup.input, random_rotation(7), scale, shift);
  setup.subdivision = Subdivision::uniform;
  setup.max_edge = 0.4 * scale;
  make_furnace(setup);
  return run(world, setup, method);
}

/// The largest difference between the values of two runs, each in ascending order: the elements' own order
/// may turn on a rounding.
double largest_change(std::vector<double> a, std::vector<double> b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  std::ranges::sort(a);
  std::ranges::sort(b);
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

/// What moving or scaling has changed: in B, or in a row's sum, where a lost pair would show.
Measurement change(const Run& moved, const Run& here) {
  const auto red = [](const Run& result) {
    std::vector<double> values;
    for (const Rgb& B : result.radiosity.B) values.push_back(B.r);
    return values;
  };
  return {std::max(largest_change(red(moved), red(here)), largest_change(moved.row_sums, here.row_sums)),
          moved.radiosity.converged};
}

Measurement worst_leak(const Communicator& world, const Method& method, double thickness, bool cut,
                       unsigned rotations) {
  Measurement worst;
  for (unsigned rotation = 0; rotation < rotations; ++rotation) {
    for (const Wall wall : {Wall::sheet, Wall::two_faces, Wall::box}) {
      DarkRoom room = dark_room(wall, thickness, Sides::one, rotation);
      room.setup.cut = cut;
      const Run result = run(world, room.setup, method);
      worst.error = std::max(worst.error, leak(room, result));
      worst.converged = worst.converged && result.radiosity.converged;
    }
  }
  return worst;
}

}  // namespace

std::vector<Situation> leak_situations() {
  // A thickness of 1e-9 of the room is below single precision: to the rays it is 0.
  const std::vector<double> thicknesses{1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2};
  return {
      {.name = "dark-room",
       .title = "Dark room behind a thin wall, patches cut",
       .parameter = "thickness of the wall / length of the room",
       .error = "mean B in the dark room / E of the light",
       .threshold = 0,
       .log_parameter = true,
       .values = thicknesses,
       .coarse_values = {1e-9, 1e-6, 1e-3},
       .measure = [](const Communicator& world, const Method& method,
                     double thickness) { return worst_leak(world, method, thickness, true, 4); }},
      {.name = "dark-room-uncut",
       .title = "Dark room behind a thin wall, patches not cut",
       .parameter = "thickness of the wall / length of the room",
       .error = "mean B in the dark room / E of the light",
       // Without cuts elements lie in both rooms: the leak is stated, not excused.
       .threshold = 5e-3,
       .log_parameter = true,
       .values = thicknesses,
       .coarse_values = {1e-6},
       .measure = [](const Communicator& world, const Method& method,
                     double thickness) { return worst_leak(world, method, thickness, false, 2); }},
      {.name = "shift",
       .title = "Concave furnace far from the origin",
       .parameter = "shift along each axis [m]",
       .error = "largest change of B or of a row sum",
       .threshold = 1e-6,
       .log_parameter = true,
       .values = {1, 10, 100, 1e3, 1e4, 1e5},
       .coarse_values = {1, 1e5},
       .measure =
           [](const Communicator& world, const Method& method, double shift) {
             return change(furnace(world, method, 1, glm::dvec3(shift)),
                           furnace(world, method, 1, glm::dvec3(0)));
           }},
      {.name = "scale",
       .title = "Concave furnace, large and small",
       .parameter = "scale",
       .error = "largest change of B or of a row sum",
       .threshold = 1e-6,
       .log_parameter = true,
       .values = {1e-3, 1e-2, 0.1, 0.5, 2, 10, 100, 1e3},
       .coarse_values = {1e-3, 1e3},
       .measure =
           [](const Communicator& world, const Method& method, double scale) {
             return change(furnace(world, method, scale, glm::dvec3(0)),
                           furnace(world, method, 1, glm::dvec3(0)));
           }},
  };
}

}  // namespace fluxel::lab
