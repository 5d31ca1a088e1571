#include <string>
#include <utility>

#include "tests/closed_forms/cases.hpp"
#include "tests/closed_forms/closed_forms.hpp"
#include "tests/closed_forms/shapes.hpp"

namespace fluxel::closed_forms {

namespace {

constexpr int kDiscCorners = 64;
constexpr int kSphereFrequency = 6;  // 720 triangles

/// Nothing stands between; the error of the polygons by contour integrals.
Case curved(std::string id, std::string what, std::vector<Polygon> sender, std::vector<Polygon> receiver,
            double exact) {
  const double found = exchange_area(sender, receiver) / area(sender);
  return {.id = std::move(id),
          .what = std::move(what),
          .sender = std::move(sender),
          .receiver = std::move(receiver),
          .blockers = {},
          .exact = exact,
          .geometry_error = found / exact - 1};
}

Case discs(std::string id, double radius_1, double radius_2, double gap) {
  return curved(std::move(id), "coaxial discs, each as one polygon of 64 sides and the disc's area",
                {disc(kDiscCorners, radius_1, 0)}, {reversed(disc(kDiscCorners, radius_2, gap))},
                coaxial_discs(radius_1, radius_2, gap));
}

/// Of radius 1/2, its centre 1 above z = 0. The icosahedron keeps the symmetry of three coordinate planes and
/// of exchanging the axes in turn, so that the 24 quarters of a cube's faces get equal shares: 1/24 (V15)
/// stays exact.
std::vector<Polygon> hanging_sphere() { return geodesic_sphere(kSphereFrequency, {0, 0, 1}, 0.5); }

/// The body's whole power reaches the shell, and F from shell to body and back to itself is a ratio of areas,
/// for polyhedra as well: no error by their shape.
void add_shell(std::vector<Case>& cases, const std::string& id, const std::string& what,
               const std::vector<Polygon>& body, const std::vector<Polygon>& shell) {
  const NestedFactors factors = convex_body_in_shell(area(body), area(shell));
  cases.push_back({.id = id + "12",
                   .what = what + ": body to shell",
                   .sender = body,
                   .receiver = shell,
                   .blockers = {},
                   .exact = 1});
  cases.push_back({.id = id + "21",
                   .what = what + ": shell to body",
                   .sender = shell,
                   .receiver = body,
                   .blockers = {},
                   .exact = factors.outer_to_inner});
  cases.push_back({.id = id + "22",
                   .what = what + ": shell to itself past the body",
                   .sender = shell,
                   .receiver = shell,
                   .blockers = body,
                   .exact = factors.outer_to_outer,
                   .occluded = true});
}

}  // namespace

std::vector<Case> curved_cases() {
  std::vector<Case> cases{
      discs("V12", 1, 1, 1),
      discs("V13a", 1, 2, 1),
      discs("V13b", 2, 1, 1),
      discs("V14", 1, 1, 10),
      curved("V15", "sphere above a square's corner, as 720 triangles", hanging_sphere(),
             {horizontal({0, 1, 0, 1}, 0)}, sphere_to_rectangle(1, 1, 1)),
      curved("V17", "sphere above a coaxial disc, as 720 triangles and 64 sides", hanging_sphere(),
             {disc(kDiscCorners, 1, 0)}, sphere_to_coaxial_disc(1, 1)),
  };
  constexpr int kShellFrequency = 4;  // 320 triangles
  add_shell(cases, "S", "concentric spheres of radii 1/2 and 1, 320 triangles each",
            geodesic_sphere(kShellFrequency, glm::dvec3(0), 0.5),
            reversed(geodesic_sphere(kShellFrequency, glm::dvec3(0), 1)));
  add_shell(cases, "C", "cube of side 1 in a cube of side 3", cube(glm::dvec3(0), 1),
            reversed(cube(glm::dvec3(0), 3)));
  return cases;
}

}  // namespace fluxel::closed_forms
