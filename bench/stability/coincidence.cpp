#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "bench/stability/rooms.hpp"
#include "bench/stability/situation_lists.hpp"
#include "tests/closed_forms/rectangles.hpp"

namespace fluxel::lab {

namespace {

/// A black room as large as the Cornell box with its light `gap` below the ceiling, both facing down: the
/// floor's irradiance against the closed form.
Measurement light_in_ceiling(const Communicator& world, const Method& method, double gap_by_extent) {
  constexpr double kWidth = 556, kHeight = 548.8, kDepth = 559.2;
  const double z = kHeight - gap_by_extent * kDepth;
  Setup setup;
  add_polygon(setup.input, "floor", 0, 0, {{0, 0, 0}, {kWidth, 0, 0}, {kWidth, kDepth, 0}, {0, kDepth, 0}});
  add_polygon(setup.input, "ceiling", 0, 0,
              {{0, 0, kHeight}, {0, kDepth, kHeight}, {kWidth, kDepth, kHeight}, {kWidth, 0, kHeight}});
  add_polygon(setup.input, "light", 0, 1, {{213, 227, z}, {213, 332, z}, {343, 332, z}, {343, 227, z}});
  setup.subdivision = Subdivision::uniform;
  setup.max_edge = 100;
  const Run result = run(world, setup, method);
  const double exact = closed_forms::parallel_rectangles({0, kWidth, 0, kDepth}, {213, 343, 227, 332}, z);
  const double error = std::abs(result.mean_H("floor") / exact - 1);
  return {std::isnan(error) ? std::numeric_limits<double>::infinity() : error, result.radiosity.converged};
}

/// A furnace whose every wall is there twice, the second `gap` behind the first or, in the file, before it:
/// what is seen must stay 1, and is neither doubled nor hidden by its double.
Measurement duplicates(const Communicator& world, const Method& method, double gap) {
  Measurement worst;
  for (const bool outer_first : {false, true}) {
    Setup setup;
    const auto add = [&](bool outer) {
      const double margin = outer ? gap : 0;
      add_box(setup.input, outer ? "outer" : "inner", 0.5, 0.5, glm::dvec3(-margin), glm::dvec3(1 + margin),
              false);
    };
    add(outer_first);
    add(!outer_first);
    transform(setup.input, random_rotation(3), 1, glm::dvec3(0));
    setup.subdivision = Subdivision::uniform;
    setup.max_edge = 0.25;
    const Run result = run(world, setup, method);
    // Where the doubles are one, either of them is what is seen.
    const double inner = result.mean_B("inner"), outer = result.mean_B("outer");
    const double seen = std::isnan(inner) ? outer : inner;
    worst.error = std::max(worst.error, std::abs(seen - 1));
    worst.converged = worst.converged && result.radiosity.converged;
  }
  return worst;
}

/// Two squares side by side in one plane but for a gap in height, both facing up; the higher one emits.
/// Exactly 0 goes from one to the other.
Measurement side_by_side(const Communicator& world, const Method& method, double step) {
  Measurement worst;
  for (unsigned number = 0; number < 20; ++number) {
    Setup setup;
    add_polygon(setup.input, "dark", 0.5, 0, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    add_polygon(setup.input, "light", 0.5, 1, {{1, 0, step}, {2, 0, step}, {2, 1, step}, {1, 1, step}});
    transform(setup.input, random_rotation(number), 1, glm::dvec3(0));
    setup.subdivision = Subdivision::uniform;
    setup.max_edge = 0.25;
    setup.sides = number % 2 == 0 ? Sides::one : Sides::two;
    const Run result = run(world, setup, method);
    worst.error = std::max(worst.error, result.mean_B("dark"));
    worst.converged = worst.converged && result.radiosity.converged;
  }
  return worst;
}

}  // namespace

std::vector<Situation> coincidence_situations() {
  const std::vector<double> gaps{1e-9, 1e-8, 1e-7, 3e-7, 1e-6, 3e-6, 1e-5, 1e-4, 1e-3};
  return {
      {.name = "side-by-side",
       .title = "Two squares of nearly one plane",
       .parameter = "step between the planes / edge",
       .error = "B of the dark square / E of the other",
       .threshold = 0,
       .log_parameter = true,
       .values = gaps,
       .coarse_values = {1e-9, 1e-6},
       .measure = side_by_side},
      {.name = "light-in-ceiling",
       .title = "A light in the plane of the ceiling or just below",
       .parameter = "gap / extent",
       .error = "relative error of the floor's irradiance",
       .threshold = 1e-3,
       .log_parameter = true,
       .values = gaps,
       .coarse_values = {1e-9, 1e-6, 1.8e-5},
       .measure = light_in_ceiling},
      {.name = "duplicates",
       .title = "Furnace with every wall there twice",
       .parameter = "gap / extent",
       .error = "|mean B of what is seen - 1|",
       .threshold = 1e-3,
       .log_parameter = true,
       .values = gaps,
       .coarse_values = {1e-9, 1e-6},
       .measure = duplicates},
  };
}

}  // namespace fluxel::lab
