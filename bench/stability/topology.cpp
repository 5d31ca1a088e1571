#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "bench/stability/rooms.hpp"
#include "bench/stability/situation_lists.hpp"

namespace fluxel::lab {

namespace {

/// A cube whose faces are split in three at their own places, so that corners lie inside neighbours' edges:
/// the furnace, and no ray may find a crack.
Measurement t_junctions(const Communicator& world, const Method& method, double rotation) {
  SceneInput box;
  add_box(box, "room", 0.5, 0, glm::dvec3(0), glm::dvec3(1), false);
  Setup setup;
  double u = 0.29, v = 0.37;
  for (const InputPolygon& face : box.polygons) {
    const auto at = [&](double a, double b) {
      return face.corners[0] + a * (face.corners[1] - face.corners[0]) +
             b * (face.corners[3] - face.corners[0]);
    };
    add_polygon(setup.input, "room", 0.5, 0, {at(0, 0), at(u, 0), at(u, 1), at(0, 1)});
    add_polygon(setup.input, "room", 0.5, 0, {at(u, 0), at(1, 0), at(1, v), at(u, v)});
    add_polygon(setup.input, "room", 0.5, 0, {at(u, v), at(1, v), at(1, 1), at(u, 1)});
    u += 0.07;
    v += 0.05;
  }
  transform(setup.input, random_rotation(static_cast<unsigned>(rotation)), 1, glm::dvec3(0));
  setup.subdivision = Subdivision::uniform;
  setup.max_edge = 0.25;
  make_furnace(setup);
  const Run result = run(world, setup, method);
  if (largest_escape_fraction(result) > 0) return {std::numeric_limits<double>::infinity(), false};
  return {furnace_error(result), result.radiosity.converged};
}

/// A cube of 4 x 4 patches a face, lit by one of them, with that fraction of the others turned round; the
/// light inside, a value for each patch, whichever side looks there.
std::vector<double> light_inside(const Communicator& world, const Method& method, Sides sides,
                                 double turned_fraction, bool& converged) {
  constexpr int kSplit = 4;
  SceneInput box;
  add_box(box, "room", 0.5, 0, glm::dvec3(-0.5), glm::dvec3(0.5), false);
  Setup setup;
  std::mt19937_64 random(5);
  for (const InputPolygon& face : box.polygons) {
    for (int cell = 0; cell < kSplit * kSplit; ++cell) {
      const auto at = [&](int a, int b) {
        return face.corners[0] + (a + cell % kSplit) / double{kSplit} * (face.corners[1] - face.corners[0]) +
               (b + cell / kSplit) / double{kSplit} * (face.corners[3] - face.corners[0]);
      };
      std::vector<glm::dvec3> corners{at(0, 0), at(1, 0), at(1, 1), at(0, 1)};
      const bool light = setup.input.polygons.empty();
      const bool turned = static_cast<double>(random() >> 11) * 0x1p-53 < turned_fraction;
      if (turned && !light) std::ranges::reverse(corners);
      add_polygon(setup.input, "room", 0.7, light ? 1 : 0, corners);
    }
  }
  setup.sides = sides;
  const Run result = run(world, setup, method);
  converged = result.radiosity.converged;
  const std::size_t elements = result.mesh.elements.size();
  std::vector<double> inside(elements);
  for (std::size_t i = 0; i < elements; ++i) {
    const Element& element = result.mesh.elements[i];
    const std::size_t unknown = glm::dot(element.normal, element.centroid) < 0 ? i : elements + i;
    const double B = unknown < result.unknowns.size() ? result.radiosity.B[unknown].r : 0;
    inside[index(element.patch)] = B;
  }
  return inside;
}

Measurement flipped_windings(const Communicator& world, const Method& method, Sides sides, double turned) {
  bool converged = true, straight_converged = true;
  const std::vector<double> found = light_inside(world, method, sides, turned, converged);
  const std::vector<double> straight = light_inside(world, method, sides, 0, straight_converged);
  Measurement result{0, converged && straight_converged};
  for (std::size_t i = 0; i < found.size(); ++i)
    result.error = std::max(result.error, std::abs(found[i] / straight[i] - 1));
  return result;
}

/// The furnace beside plates that see nothing at all: their rows are empty.
Measurement empty_rows(const Communicator& world, const Method& method, double plates) {
  Setup setup;
  add_box(setup.input, "room", 0.5, 0.5, glm::dvec3(0), glm::dvec3(1), false);
  for (int k = 0; k < static_cast<int>(plates); ++k) {
    const double z = -1 - k;
    add_polygon(setup.input, "plates", 0.5, 0.5, {{0, 0, z}, {0, 1, z}, {1, 1, z}, {1, 0, z}});
  }
  setup.subdivision = Subdivision::uniform;
  setup.max_edge = 0.25;
  const Run result = run(world, setup, method);
  const double off = std::max(std::abs(result.mean_B("room") - 1), std::abs(result.mean_B("plates") - 0.5));
  return {std::isfinite(off) ? off : std::numeric_limits<double>::infinity(), result.radiosity.converged};
}

/// A furnace that emits from nearly nothing to very much: B / E must not change.
Measurement emission(const Communicator& world, const Method& method, double E) {
  Setup setup;
  add_box(setup.input, "room", 0.5, 1, glm::dvec3(0), glm::dvec3(1), false);
  setup.subdivision = Subdivision::uniform;
  setup.max_edge = 0.25;
  const auto light = [&](double exitance) {
    setup.adjust = [exitance](const ElementMesh&, Unknowns& unknowns) {
      std::ranges::fill(unknowns.E, Rgb(exitance));
    };
    return run(world, setup, method);
  };
  const Run one = light(1), found = light(E);
  const double off = std::abs(found.mean_B("room") / E / one.mean_B("room") - 1);
  return {std::isfinite(off) ? off : std::numeric_limits<double>::infinity(), found.radiosity.converged};
}

}  // namespace

std::vector<Situation> topology_situations() {
  return {
      {.name = "t-junctions",
       .title = "Furnace with T-junctions, rotated",
       .parameter = "number of the random rotation",
       .error = "max |B - 1|, infinite where a ray escapes",
       .threshold = 1e-3,
       .log_parameter = false,
       .values = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9},
       .coarse_values = {0, 1},
       .measure = t_junctions},
      {.name = "flipped-two-sided",
       .title = "Patches turned round, both sides taking part",
       .parameter = "fraction turned round",
       .error = "largest relative change of B inside",
       .threshold = 1e-12,
       .log_parameter = false,
       .values = {0.1, 0.25, 0.5, 0.75, 1},
       .coarse_values = {0.5},
       .measure = [](const Communicator& world, const Method& method,
                     double turned) { return flipped_windings(world, method, Sides::two, turned); }},
      {.name = "flipped-one-sided",
       .title = "Patches turned round, fronts alone taking part",
       .parameter = "fraction turned round",
       .error = "largest relative change of B inside",
       .threshold = 1e-12,
       .log_parameter = false,
       .values = {0, 0.1, 0.25, 0.5, 0.75},
       .coarse_values = {0},  // what is turned round is dark by definition
       .measure = [](const Communicator& world, const Method& method,
                     double turned) { return flipped_windings(world, method, Sides::one, turned); }},
      {.name = "empty-rows",
       .title = "Furnace beside plates that see nothing",
       .parameter = "plates",
       .error = "|mean B - exact|",
       .threshold = 1e-3,
       .log_parameter = true,
       .values = {1, 10, 100},
       .coarse_values = {10},
       .measure = empty_rows},
      {.name = "emission",
       .title = "From almost no light to very much",
       .parameter = "E [W/m2]",
       .error = "relative change of B / E",
       .threshold = 1e-6,
       .log_parameter = true,
       .values = {1e-300, 1e-40, 1e-35, 1e-30, 1e-20, 1e-10, 1, 1e10, 1e20, 1e30, 1e35, 1e40},
       .coarse_values = {1e-30, 1e30},
       .measure = emission},
  };
}

}  // namespace fluxel::lab
