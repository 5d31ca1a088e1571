#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "bench/stability/view_setup.hpp"
#include "tests/closed_forms/closed_forms.hpp"
#include "tests/closed_forms/shapes.hpp"
#include "tests/stability/world.hpp"

namespace fluxel {
namespace {

using closed_forms::Polygon;

/// Two groups of polygons, each of one material.
struct Pair {
  std::vector<Polygon> first, second;
  closed_forms::Surface surface_1, surface_2;
  double max_edge = 0;  ///< 0: an element a polygon
};

lab::Run solve(const Pair& pair, const char* method = "adaptive") {
  lab::Setup setup;
  for (const Polygon& polygon : pair.first)
    lab::add_polygon(setup.input, "first", pair.surface_1.rho, pair.surface_1.E, polygon);
  for (const Polygon& polygon : pair.second)
    lab::add_polygon(setup.input, "second", pair.surface_2.rho, pair.surface_2.E, polygon);
  if (pair.max_edge > 0) {
    setup.subdivision = Subdivision::uniform;
    setup.max_edge = pair.max_edge;
  }
  lab::Run run = lab::run(test::world(), setup, lab::method_named(method));
  EXPECT_TRUE(run.radiosity.converged) << run.radiosity.cause;
  return run;
}

TEST(ExactSolutions, TwoPlatesInBlackSurroundings) {
  constexpr closed_forms::Rectangle kUnitSquare{0, 1, 0, 1};
  constexpr closed_forms::Surface kLit{.E = 1, .rho = 0.8}, kOther{.E = 0.25, .rho = 0.6};
  for (const double gap : {0.001, 0.1, 1.0, 3.0, 10.0}) {
    const lab::Run run = solve({{closed_forms::horizontal(kUnitSquare, 0)},
                                {closed_forms::reversed(closed_forms::horizontal(kUnitSquare, gap))},
                                kLit,
                                kOther});
    const double F = closed_forms::opposed_rectangles(1, 1, gap);
    const auto exact = closed_forms::two_elements(kLit, kOther, F, F);
    EXPECT_NEAR(run.mean_B("first") / exact.B1, 1, 1e-3) << gap;
    EXPECT_NEAR(run.mean_B("second") / exact.B2, 1, 1e-3) << gap;
  }
}

// So close that nearly nothing escapes at the edges: B1 = (E1 + rho1 E2) / (1 - rho1 rho2).
TEST(ExactSolutions, PlatesSoWideThatTheyAreInfinite) {
  constexpr closed_forms::Rectangle kUnitSquare{0, 1, 0, 1};
  constexpr closed_forms::Surface kLit{.E = 1, .rho = 0.8}, kOther{.E = 0.25, .rho = 0.6};
  const lab::Run run = solve({{closed_forms::horizontal(kUnitSquare, 0)},
                              {closed_forms::reversed(closed_forms::horizontal(kUnitSquare, 1e-4))},
                              kLit,
                              kOther});
  const auto exact = closed_forms::two_elements(kLit, kOther, 1, 1);
  EXPECT_NEAR(run.mean_B("first") / exact.B1, 1, 1e-3);
  EXPECT_NEAR(run.mean_B("second") / exact.B2, 1, 1e-3);
}

/// A cube of side 1 within a cube of side 3, the shell's surfaces seeing each other past the body.
Pair boxes(const closed_forms::Surface& inner, const closed_forms::Surface& outer) {
  return {closed_forms::cube(glm::dvec3(0), 1), closed_forms::reversed(closed_forms::cube(glm::dvec3(0), 3)),
          inner, outer, 0.25};
}

// A convex body hides nothing of a shell that shines everywhere alike: H = 1 at every point of it, and 1/9 of
// the shell's light falls on it.
TEST(ExactSolutions, ConcentricBoxes) {
  const lab::Run shell_shines = solve(boxes({.E = 0, .rho = 0}, {.E = 1, .rho = 0}));
  double largest = 0;
  for (std::size_t i = 0; i < shell_shines.mesh.elements.size(); ++i) {
    const Patch& patch = shell_shines.scene.patch(shell_shines.mesh.elements[i].patch);
    if (shell_shines.scene.groups[index(patch.group)] == "first")
      largest = std::max(largest, std::abs(shell_shines.radiosity.H[i].r - 1));
  }
  const double on_shell = shell_shines.mean_H("second");
  const lab::Run body_shines = solve(boxes({.E = 1, .rho = 0}, {.E = 0, .rho = 0}));
  const double on_ninth = body_shines.mean_H("second");
  std::printf("boxes: largest |H - 1| of the inner %.2g, errors of the outer's mean %+.2g %+.2g\n", largest,
              on_shell / (8.0 / 9) - 1, on_ninth * 9 - 1);
  EXPECT_LE(largest, 2e-3);
  EXPECT_NEAR(on_shell / (8.0 / 9), 1, 2e-3);
  EXPECT_NEAR(on_ninth * 9, 1, 2e-3);
}

// Triangles stand for the spheres: theirs is the area ratio that the solution uses. The outer sphere's
// corners lie on it, so that the body's share differs from place to place by its facets.
TEST(ExactSolutions, ConcentricSpheres) {
  constexpr closed_forms::Surface kInner{.E = 1, .rho = 0.5}, kOuter{.E = 0, .rho = 0.8};
  for (const auto& [lit, other] : {std::pair{kInner, kOuter}, std::pair{kOuter, kInner}}) {
    Pair pair{closed_forms::geodesic_sphere(5, glm::dvec3(0), 1),
              closed_forms::reversed(closed_forms::geodesic_sphere(8, glm::dvec3(0), 2)),
              {.E = lit.E, .rho = lit.rho},
              {.E = other.E, .rho = other.rho}};
    const double k = closed_forms::area(pair.first) / closed_forms::area(pair.second);
    const auto exact = closed_forms::concentric_spheres_radiosity(pair.surface_1, pair.surface_2, k);
    for (const char* method : {"adaptive", "adaptive, closure"}) {
      const lab::Run run = solve(pair, method);
      const double inner = run.mean_B("first") / exact.B1 - 1, outer = run.mean_B("second") / exact.B2 - 1;
      std::printf("spheres, %s: errors of the inner's and the outer's mean %+.2g %+.2g\n", method, inner,
                  outer);
      // A row's sum may err by the tolerance, 1e-3, which the reflections between the spheres multiply by 5
      // at most: by 1 / (1 - rho of the outer). Closure leaves what is random in the pairs.
      const double allowed = run.form_factors.closure ? 1e-5 : 1e-3 / (1 - 0.8);
      EXPECT_NEAR(inner, 0, allowed) << method;
      EXPECT_NEAR(outer, 0, allowed) << method;
    }
  }
}

}  // namespace
}  // namespace fluxel
