#include <numbers>

#include "bench/stability/situation_lists.hpp"
#include "bench/stability/view_setup.hpp"
#include "tests/closed_forms/closed_forms.hpp"
#include "tests/closed_forms/shapes.hpp"

namespace fluxel::lab {

namespace {

constexpr closed_forms::Rectangle kUnitSquare{0, 1, 0, 1};

Measurement measure_hinge(const Communicator& world, const Method& method, double degrees) {
  const auto [lying, raised] = closed_forms::hinged_squares(degrees * std::numbers::pi / 180);
  return measure_view(world, method, {lying, raised, {}}, closed_forms::polygon_to_polygon(lying, raised));
}

Measurement measure_gap(const Communicator& world, const Method& method, double gap) {
  const closed_forms::Polygon receiver = closed_forms::reversed(closed_forms::horizontal(kUnitSquare, gap));
  return measure_view(world, method, {closed_forms::horizontal(kUnitSquare, 0), receiver, {}},
                      closed_forms::opposed_rectangles(1, 1, gap));
}

}  // namespace

std::vector<Situation> contact_situations() {
  return {{.name = "edge-contact",
           .title = "Two squares with a common edge, one element each",
           .parameter = "angle between them [degrees]",
           .error = "relative error of the view factor",
           .threshold = 1e-3,
           .log_parameter = false,
           .values = {1, 2, 5, 10, 20, 30, 45, 60, 75, 90, 105, 120, 135, 150, 165, 175, 179},
           .coarse_values = {1, 10, 90, 150, 165},
           .measure = measure_hinge},
          {.name = "gap",
           .title = "Two parallel squares, one element each",
           .parameter = "gap [sides]",
           .error = "relative error of the view factor",
           .threshold = 1e-3,
           .values = {0.001, 0.003, 0.01, 0.03, 0.1, 0.2, 0.5, 1, 2, 3, 5, 7, 10},
           .coarse_values = {0.001, 0.1, 1, 3, 10},
           .measure = measure_gap}};
}

}  // namespace fluxel::lab
