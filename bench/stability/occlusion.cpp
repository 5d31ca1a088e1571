#include "bench/stability/situation_lists.hpp"
#include "bench/stability/view_setup.hpp"
#include "tests/closed_forms/closed_forms.hpp"
#include "tests/closed_forms/shapes.hpp"

namespace fluxel::lab {

namespace {

using closed_forms::Rectangle;

/// Unit squares at z = 0 and z = 1 with rectangles halfway between them.
Measurement measure_past(const Communicator& world, const Method& method,
                         const std::vector<Rectangle>& blockers, double max_edge) {
  constexpr Rectangle kUnitSquare{0, 1, 0, 1};
  View view{closed_forms::horizontal(kUnitSquare, 0),
            closed_forms::reversed(closed_forms::horizontal(kUnitSquare, 1)),
            {},
            max_edge};
  for (const Rectangle& blocker : blockers) view.blockers.push_back(closed_forms::horizontal(blocker, 0.5));
  return measure_view(world, method, view, closed_forms::opposed_squares_past(blockers));
}

Measurement measure_centred(const Communicator& world, const Method& method, double side) {
  return measure_past(world, method, {closed_forms::centred_blocker(side)}, 0);
}

Measurement measure_curtain(const Communicator& world, const Method& method, double width) {
  return measure_past(world, method, {{0, width, 0, 1}}, 0);
}

Measurement measure_half(const Communicator& world, const Method& method, double n) {
  return measure_past(world, method, {{0, 0.5, 0, 1}}, 1 / n);
}

Measurement measure_quadrant(const Communicator& world, const Method& method, double n) {
  return measure_past(world, method, {{0, 0.5, 0, 0.5}}, 1 / n);
}

Measurement measure_centred_refined(const Communicator& world, const Method& method, double n) {
  return measure_past(world, method, {closed_forms::centred_blocker(0.5)}, 1 / n);
}

/// Slats as wide as the spaces between them.
Measurement measure_comb(const Communicator& world, const Method& method, double slats) {
  constexpr double kEdge = 1.0 / 8;
  std::vector<Rectangle> blockers;
  for (int slat = 0; slat < slats; ++slat) blockers.push_back({slat / slats, (slat + 0.5) / slats, 0, 1});
  return measure_past(world, method, blockers, kEdge);
}

}  // namespace

std::vector<Situation> occlusion_situations() {
  const std::string error = "relative error of the view factor";
  const std::vector<double> refinements{1, 2, 4, 8, 16};
  return {{.name = "hidden-centres",
           .title = "A square before the centres of two squares, one element each",
           .parameter = "side of the blocker [sides]",
           .error = error,
           .threshold = 0.05,
           .log_parameter = false,
           .values = {0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9},
           .coarse_values = {0.1, 0.2, 0.5, 0.7},
           .measure = measure_centred},
          {.name = "half-hidden",
           .title = "A curtain between two squares, one element each",
           .parameter = "width of the curtain [sides]",
           .error = error,
           .threshold = 0.05,
           .log_parameter = false,
           .values = {0.05, 0.1, 0.2, 0.3, 0.4, 0.49, 0.51, 0.6, 0.7, 0.8, 0.9},
           .coarse_values = {0.1, 0.3, 0.49, 0.7},
           .measure = measure_curtain},
          {.name = "blocker-half",
           .title = "A half of the view hidden",
           .parameter = "elements along an edge",
           .error = error,
           .threshold = 2e-3,
           .values = refinements,
           .coarse_values = {8},
           .measure = measure_half},
          {.name = "blocker-quadrant",
           .title = "A quarter of the view hidden",
           .parameter = "elements along an edge",
           .error = error,
           .threshold = 2e-3,
           .values = refinements,
           .coarse_values = {8},
           .measure = measure_quadrant},
          {.name = "blocker-centred",
           .title = "A square blocker half as wide between two squares",
           .parameter = "elements along an edge",
           .error = error,
           .threshold = 2e-3,
           .values = refinements,
           .coarse_values = {8},
           .measure = measure_centred_refined},
          {.name = "slats",
           .title = "Slats that hide one half between two squares, 8 x 8 elements each",
           .parameter = "slats",
           .error = error,
           .threshold = 0.02,
           .values = {1, 2, 3, 4, 8, 11, 16, 23, 32, 50, 64},
           .coarse_values = {4, 50, 64},
           .measure = measure_comb}};
}

}  // namespace fluxel::lab
