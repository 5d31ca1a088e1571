#include "tests/closed_forms/cases.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <set>

#include "tests/closed_forms/quadrature.hpp"
#include "tests/closed_forms/shapes.hpp"

namespace fluxel::closed_forms {
namespace {

TEST(Cases, FlatOnesByContour) {
  for (const Case& view : flat_cases()) {
    EXPECT_NEAR(exchange_area(view.sender, view.receiver) / area(view.sender), view.exact, 1e-12) << view.id;
    EXPECT_EQ(view.geometry_error, 0) << view.id;
    EXPECT_TRUE(view.blockers.empty()) << view.id;
  }
}

// Without the blockers more passes; each blocker lies between.
TEST(Cases, OccludedOnesLoseSomething) {
  for (const Case& view : occluded_cases()) {
    const double free = exchange_area(view.sender, view.receiver) / area(view.sender);
    EXPECT_TRUE(view.occluded) << view.id;
    EXPECT_LT(polygon_truth(view), 0.99 * free) << view.id;
    EXPECT_GT(polygon_truth(view), 0.4 * free) << view.id;
  }
}

TEST(Cases, Ids) {
  std::set<std::string> ids;
  for (const Case& view : all_cases()) {
    EXPECT_TRUE(ids.insert(view.id).second) << view.id;
    EXPECT_FALSE(view.sender.empty() || view.receiver.empty()) << view.id;
    EXPECT_EQ(view.occluded, !view.blockers.empty()) << view.id;
  }
}

// What stands in the table of cases; a change of the polygons' counts shows here.
TEST(Cases, GeometryErrorsAreSmall) {
  for (const Case& view : curved_cases()) {
    EXPECT_LT(std::abs(view.geometry_error), view.id == "V17" ? 3e-5 : 3e-7) << view.id;
  }
}

/// Exchange area by a product rule of points on the sender, cut into triangles from its first corner.
template <unsigned kPoints>
double exchange_by_points(const Polygon& sender, const Polygon& receiver) {
  const glm::dvec3 normal = glm::normalize(vector_area(sender));
  double sum = 0;
  for (std::size_t i = 2; i < sender.size(); ++i) {
    const glm::dvec3 start = sender[0], u = sender[i - 1] - start, v = sender[i] - start;
    sum += glm::length(glm::cross(u, v)) * integrate<kPoints>({0, 1, 0, 1}, [&](double a, double b) {
             return a * point_to_polygon(start + a * ((1 - b) * u + b * v), normal, receiver);
           });
  }
  return sum;
}

// The polygons' own factors, and so the geometry errors, again by Lambert's point factor.
TEST(Cases, GeometryErrorsByPoints) {
  for (const Case& view : curved_cases()) {
    if (view.id[0] != 'V') continue;
    const bool one_face = view.sender.size() == 1;  // a disc, with slender triangles
    double found = 0;
    for (const Polygon& face : view.sender) {
      found += one_face ? exchange_by_points<20>(face, view.receiver[0])
                        : exchange_by_points<7>(face, view.receiver[0]);
    }
    EXPECT_NEAR(found / area(view.sender) / polygon_truth(view), 1, 1e-8) << view.id;
  }
}

// Every face of a convex body in a closed shell sees shell alone: the row sum says that both are closed and
// face each other. A face of the empty shell sees the whole shell.
TEST(Cases, ShellsClose) {
  for (const Case& view : curved_cases()) {
    if (view.id != "S12" && view.id != "C12") continue;
    const std::vector<Polygon> body{view.sender[0]}, shell{view.receiver[0]};
    EXPECT_NEAR(exchange_area(body, view.receiver) / area(body), 1, 1e-12) << view.id;
    EXPECT_NEAR(exchange_area(shell, view.receiver) / area(shell), 1, 1e-12) << view.id;
  }
}

TEST(Cases, PointsByLambert) {
  for (const PointCase& view : point_cases()) {
    const double found = point_to_polygon(view.point, view.normal, view.receiver);
    EXPECT_NEAR(found, view.exact * (1 + view.geometry_error), 1e-15) << view.id;
    EXPECT_LT(std::abs(view.geometry_error), 1e-6) << view.id;
    EXPECT_GT(glm::dot(vector_area(view.receiver), view.point - view.receiver[0]), 0) << view.id;
  }
}

}  // namespace
}  // namespace fluxel::closed_forms
