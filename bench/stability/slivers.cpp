#include <cmath>
#include <limits>

#include "bench/stability/rooms.hpp"
#include "bench/stability/situation_lists.hpp"
#include "tests/closed_forms/shapes.hpp"

namespace fluxel::lab {

namespace {

Measurement relative_error(double found, double exact, const Run& run) {
  const double error = std::abs(found / exact - 1);
  return {std::isnan(error) ? std::numeric_limits<double>::infinity() : error, run.radiosity.converged};
}

/// A right triangle of length 1 and of width 1 / aspect, upside down at an angle over an emitting unit
/// square: its mean irradiance against the contour integral.
Measurement sliver(const Communicator& world, const Method& method, double aspect) {
  const closed_forms::Polygon square = closed_forms::horizontal({0, 1, 0, 1}, 0);
  const closed_forms::Polygon needle{{0.1, 0.2, 0.3}, {0.1, 0.2 + 1 / aspect, 0.3}, {0.9, 0.2, 0.9}};
  Setup setup;
  add_polygon(setup.input, "square", 0, 1, square);
  add_polygon(setup.input, "needle", 0, 0, needle);
  setup.subdivision = Subdivision::uniform;
  setup.max_edge = 0.25;
  const Run result = run(world, setup, method);
  return relative_error(result.mean_H("needle"), closed_forms::polygon_to_polygon(needle, square), result);
}

/// Cuts the quadrilateral a b c d along strips whose widths shrink by half towards edge a b until they are
/// `aspect` times as long as wide, each strip into two triangles.
void add_needles(SceneInput& input, const std::vector<glm::dvec3>& corners, double aspect) {
  const auto at = [&](double u, double v) {
    return corners[0] + u * (corners[1] - corners[0]) + v * (corners[3] - corners[0]);
  };
  double top = 1;
  while (true) {
    const double bottom = top * aspect > 2 ? top / 2 : 0;
    add_polygon(input, "room", 0.5, 0, {at(0, bottom), at(1, bottom), at(1, top)});
    add_polygon(input, "room", 0.5, 0, {at(0, bottom), at(1, top), at(0, top)});
    if (bottom == 0) return;
    top = bottom;
  }
}

/// The furnace in a cube of needles.
Measurement needle_soup(const Communicator& world, const Method& method, double aspect) {
  SceneInput box;
  add_box(box, "room", 0.5, 0, glm::dvec3(0), glm::dvec3(1), false);
  Setup setup;
  for (const InputPolygon& face : box.polygons) add_needles(setup.input, face.corners, aspect);
  setup.subdivision = Subdivision::uniform;
  setup.max_edge = 0.5;
  make_furnace(setup);
  const Run result = run(world, setup, method);
  return {furnace_error(result), result.radiosity.converged};
}

/// The furnace in a unit cube with a small cube in it.
Measurement size_ratio(const Communicator& world, const Method& method, double ratio) {
  Setup setup;
  add_box(setup.input, "room", 0.5, 0, glm::dvec3(0), glm::dvec3(1), false);
  const glm::dvec3 low{0.3, 0.4, 0.2};
  add_box(setup.input, "small", 0.5, 0, low, low + 1 / ratio, true);
  setup.subdivision = Subdivision::uniform;
  setup.max_edge = 0.5;
  make_furnace(setup);
  const Run result = run(world, setup, method);
  return {furnace_error(result), result.radiosity.converged};
}

}  // namespace

std::vector<Situation> sliver_situations() {
  return {
      {.name = "sliver",
       .title = "A sliver before a square",
       .parameter = "length / width of the sliver",
       .error = "relative error of its irradiance",
       .threshold = 1e-3,
       .log_parameter = true,
       .values = {1, 10, 100, 1e3, 1e4, 1e5, 1e6},
       .coarse_values = {1, 1e4},
       .measure = sliver},
      {.name = "needle-soup",
       .title = "Furnace in a cube made of needles",
       .parameter = "length / width of the finest needle",
       .error = "max |B - 1|",
       .threshold = 1e-3,
       .log_parameter = true,
       .values = {2, 8, 32, 128, 1024, 1e4},
       .coarse_values = {32, 1024},
       .measure = needle_soup},
      {.name = "size-ratio",
       .title = "Furnace with elements large and small",
       .parameter = "edge of the room / edge of the cube in it",
       .error = "max |B - 1|",
       // A row's sum may err by the tolerance, 1e-3, and the furnace multiplies that by up to rho / (1 -
       // rho).
       .threshold = 5e-3,
       .log_parameter = true,
       .values = {4, 10, 100, 1e3, 1e4, 1e5, 1e6},
       .coarse_values = {4, 1e3},
       .measure = size_ratio},
  };
}

}  // namespace fluxel::lab
