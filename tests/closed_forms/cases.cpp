#include "tests/closed_forms/cases.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "tests/closed_forms/closed_forms.hpp"
#include "tests/closed_forms/shapes.hpp"

namespace fluxel::closed_forms {

namespace {

using std::numbers::pi;

Case flat(std::string id, std::string what, Polygon sender, Polygon receiver, double exact) {
  return {.id = std::move(id),
          .what = std::move(what),
          .sender = {std::move(sender)},
          .receiver = {std::move(receiver)},
          .blockers = {},
          .exact = exact};
}

Case parallel(std::string id, std::string what, const Rectangle& sender, const Rectangle& receiver,
              double gap, double exact) {
  return flat(std::move(id), std::move(what), horizontal(sender, 0), reversed(horizontal(receiver, gap)),
              exact);
}

Case perpendicular(std::string id, std::string what, const Rectangle& sender, const Rectangle& receiver,
                   double exact) {
  return flat(std::move(id), std::move(what), horizontal(sender, 0), facing_x(receiver, 0), exact);
}

Case hinged(std::string id, double degrees) {
  auto [lying, raised] = hinged_squares(degrees * pi / 180);
  const double exact = polygon_to_polygon(lying, raised);
  return flat(std::move(id), "unit squares with a common edge", std::move(lying), std::move(raised), exact);
}

/// Faces of tetrahedra, inwards.
void add_tetrahedra(std::vector<Case>& cases) {
  const glm::dvec3 a(1, 1, 1), b(1, -1, -1), c(-1, 1, -1), d(-1, -1, 1);
  cases.push_back(flat("PT", "faces of a regular tetrahedron", {a, c, b}, {a, b, d}, 1.0 / 3));

  // The hypotenuse, of area sqrt(3)/2, sees the three legs, of 1/2, alike; each row sums to 1.
  const glm::dvec3 origin(0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  cases.push_back(flat("PQ", "legs of a corner tetrahedron", {origin, x, y}, {origin, z, x},
                       (1 - 1 / std::numbers::sqrt3) / 2));
}

/// Parallel copies at unit distance, by the contour integral.
Case opposed(std::string id, std::string what, const Polygon& sender) {
  Polygon receiver = sender;
  for (glm::dvec3& corner : receiver) corner.z += 1;
  receiver = reversed(std::move(receiver));
  const double exact = polygon_to_polygon(sender, receiver);
  return flat(std::move(id), std::move(what), sender, std::move(receiver), exact);
}

}  // namespace

double polygon_truth(const Case& view) { return view.exact * (1 + view.geometry_error); }

std::vector<Case> flat_cases() {
  constexpr Rectangle kNext{1, 2, 0, 1};
  std::vector<Case> cases{
      parallel("V1", "opposed unit squares, gap 1", kUnitSquare, kUnitSquare, 1, opposed_rectangles(1, 1, 1)),
      perpendicular("V2", "unit squares at right angles, common edge", kUnitSquare, kUnitSquare,
                    adjacent_rectangles(1, 1, 1)),
      parallel("V3", "opposed 2 x 1 rectangles, gap 1", {0, 2, 0, 1}, {0, 2, 0, 1}, 1,
               opposed_rectangles(2, 1, 1)),
      parallel("V4", "opposed unit squares, gap 10", kUnitSquare, kUnitSquare, 10,
               opposed_rectangles(1, 1, 10)),
      perpendicular("V6a", "2 wide to 1 high, common edge 1", {0, 2, 0, 1}, kUnitSquare,
                    adjacent_rectangles(2, 1, 1)),
      perpendicular("V6b", "1 wide to 2 high, common edge 1", kUnitSquare, {0, 2, 0, 1},
                    adjacent_rectangles(1, 2, 1)),
      perpendicular("V7", "strips 0.1 wide along a common edge 1", {0, 0.1, 0, 1}, {0, 0.1, 0, 1},
                    adjacent_rectangles(0.1, 0.1, 1)),
      parallel("V8", "parallel unit squares, gap 1, shifted by 1", kUnitSquare, kNext, 1,
               parallel_rectangles(kUnitSquare, kNext, 1)),
      perpendicular("V10", "unit squares at right angles, both 1 from the common line", kNext, kNext,
                    perpendicular_rectangles(kNext, kNext)),
      perpendicular("V11", "unit squares at right angles, touching in a corner", kUnitSquare, {0, 1, 1, 2},
                    perpendicular_rectangles(kUnitSquare, {0, 1, 1, 2})),
      hinged("P30", 30),
      hinged("P60", 60),
      hinged("P90", 90),
      opposed("PR", "opposed right triangles, gap 1", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}),
      opposed("PH", "opposed regular hexagons of circumradius 1, gap 1", regular_polygon(6, 1, 0)),
  };
  add_tetrahedra(cases);
  return cases;
}

std::vector<Case> all_cases() {
  std::vector<Case> cases = flat_cases();
  for (auto more : {curved_cases(), occluded_cases()}) {
    std::ranges::move(more, std::back_inserter(cases));
  }
  return cases;
}

std::vector<PointCase> point_cases() {
  constexpr Rectangle kCentred{-0.5, 0.5, -0.5, 0.5};
  const glm::dvec3 origin(0), up(0, 0, 1);
  const Polygon fine_disc = reversed(disc(64, 1, 1));
  const double disc_exact = point_to_coaxial_disc(1, 1);
  return {
      {"V19a", "below the corner of a unit square, gap 1", origin, up, reversed(horizontal(kUnitSquare, 1)),
       point_to_parallel_rectangle(kUnitSquare, 1)},
      {"V19b", "below the centre of a unit square, gap 0.5", origin, up, reversed(horizontal(kCentred, 0.5)),
       point_to_parallel_rectangle(kCentred, 0.5)},
      {"V20",
       "before a unit square's bottom corner, distance 1",
       {1, 0, 0},
       up,
       facing_x(kUnitSquare, 0),
       point_to_perpendicular_rectangle(1, kUnitSquare)},
      {"V21",
       "below a triangle",
       origin,
       up,
       {{-1, -1, 1}, {0, 1, 1}, {1, 0, 1}},
       point_to_polygon(origin, up, {{-1, -1, 1}, {0, 1, 1}, {1, 0, 1}})},
      {"V22", "below a disc's centre, radius and gap 1, as 64 sides", origin, up, fine_disc, disc_exact,
       point_to_polygon(origin, up, fine_disc) / disc_exact - 1},
  };
}

}  // namespace fluxel::closed_forms
