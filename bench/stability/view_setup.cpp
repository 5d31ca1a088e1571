#include "bench/stability/view_setup.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "tests/closed_forms/radiosity.hpp"
#include "tests/closed_forms/shapes.hpp"

namespace fluxel::lab {

Measurement measure_view(const Communicator& world, const Method& method, const View& view, double exact) {
  Setup setup;
  add_polygon(setup.input, "sender", 0, 1, view.sender);
  add_polygon(setup.input, "receiver", 0, 0, view.receiver);
  for (const closed_forms::Polygon& blocker : view.blockers)
    add_polygon(setup.input, "blocker", 0, 0, blocker);
  if (view.max_edge > 0) {
    setup.subdivision = Subdivision::uniform;
    setup.max_edge = view.max_edge;
  }
  const Run done = run(world, setup, method);
  const double found =
      done.mean_H("receiver") * closed_forms::area(view.receiver) / closed_forms::area(view.sender);
  return {std::abs(found / exact - 1), done.radiosity.converged};
}

Setup unit_cube(int n, double rho, double floor_E, double other_E) {
  Setup setup;
  for (const closed_forms::Polygon& wall : closed_forms::reversed(closed_forms::cube(glm::dvec3(0), 1))) {
    const double height = closed_forms::vector_area(wall).z;  // 1: faces up, -1: down
    const bool is_floor = height > 0.5;
    add_polygon(setup.input,
                is_floor        ? "floor"
                : height < -0.5 ? "ceiling"
                                : "sides",
                rho, is_floor ? floor_E : other_E, wall);
  }
  setup.subdivision = Subdivision::uniform;
  setup.max_edge = 1.0 / n;
  return setup;
}

Setup unit_furnace(int n, double rho_max, unsigned seed) {
  Setup setup = unit_cube(n, 0.5, 1, 1);
  setup.adjust = [rho_max, seed](const ElementMesh&, Unknowns& unknowns) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> rho(0, rho_max);
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
      unknowns.rho[i] = Rgb(rho(random));
      unknowns.E[i] = Rgb(1) - unknowns.rho[i];
    }
  };
  return setup;
}

Measurement measure_wall_averages(const Run& run, double rho) {
  const auto known = std::ranges::find_if(closed_forms::kContinuousCube,
                                          [&](const auto& solution) { return solution.rho == rho; });
  if (known == closed_forms::kContinuousCube.end())
    throw std::out_of_range("the cube's continuous solution is not known for this reflectance");
  if (!run.radiosity.converged) return {std::numeric_limits<double>::infinity(), false};
  const closed_forms::CubeWalls& exact = known->mean;
  return {std::max({std::abs(run.mean_B("floor") / exact.emitter - 1),
                    std::abs(run.mean_B("ceiling") / exact.opposite - 1),
                    std::abs(run.mean_B("sides") / exact.side - 1)}),
          true};
}

}  // namespace fluxel::lab
