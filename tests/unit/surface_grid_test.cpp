#include "scene/surface_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace fluxel {
namespace {

const Polygon kFloor{{0, 0, 1}, {4, 0, 1}, {4, 2, 1}, {0, 2, 1}};

SurfaceGrid upwards() {
  SurfaceGrid grid;
  grid.normal = {0, 0, 1};
  return grid;
}

TEST(SurfaceGrid, LiesOverARectangle) {
  SurfaceGrid grid = upwards();
  grid.offset = 0.8;
  grid.border = 0.5;
  grid.spacing = 0.4;
  Receiver receiver;
  ASSERT_EQ(lay_on_surface(std::vector<Polygon>{kFloor}, grid, receiver), std::nullopt);
  EXPECT_EQ(receiver.columns, 8);
  EXPECT_EQ(receiver.rows, 3);
  EXPECT_TRUE(receiver.unmeasured.empty());
  EXPECT_NEAR(glm::length(receiver.origin - glm::dvec3(0.5, 0.5, 1.8)), 0, 1e-12);
  EXPECT_NEAR(glm::length(glm::cross(receiver.u, receiver.v) - glm::dvec3(0, 0, 3)), 0, 1e-12);
}

TEST(SurfaceGrid, TheNormalDecidesTheSideWhateverTheWinding) {
  Polygon turned = kFloor;
  std::ranges::reverse(turned);
  for (const Polygon& floor : {kFloor, turned}) {
    for (const double side : {1.0, -1.0}) {
      SurfaceGrid grid = upwards();
      grid.normal = {0.1, 0, side};
      grid.offset = 0.5;
      Receiver receiver;
      ASSERT_EQ(lay_on_surface(std::vector<Polygon>{floor}, grid, receiver), std::nullopt);
      EXPECT_NEAR(receiver.place(0, 0.5, 0.5).z, 1 + 0.5 * side, 1e-12);
      EXPECT_GT(glm::cross(receiver.u, receiver.v).z * side, 0);
    }
  }
}

TEST(SurfaceGrid, LeavesOutWhatIsNotAboveTheSurface) {
  // An L of two rectangles: three quarters of the square around it.
  const std::vector<Polygon> floor{{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}},
                                   {{0, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}};
  Receiver receiver;
  receiver.columns = receiver.rows = 8;
  ASSERT_EQ(lay_on_surface(floor, upwards(), receiver), std::nullopt);
  EXPECT_EQ(std::ranges::count(receiver.unmeasured, 1), 16);
  for (std::size_t cell = 0; cell < receiver.size(); ++cell) {
    const glm::dvec3 middle = receiver.place(cell, 0.5, 0.5);
    EXPECT_EQ(receiver.measures(cell), middle.x < 1 || middle.y < 1) << middle.x << ' ' << middle.y;
  }
}

TEST(SurfaceGrid, TheBorderIsAlongInnerCornersToo) {
  const std::vector<Polygon> floor{{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}},
                                   {{0, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}};
  SurfaceGrid grid = upwards();
  grid.border = 0.2;
  Receiver receiver;
  receiver.columns = receiver.rows = 16;
  ASSERT_EQ(lay_on_surface(floor, grid, receiver), std::nullopt);
  for (std::size_t cell = 0; cell < receiver.size(); ++cell) {
    const glm::dvec3 middle = receiver.place(cell, 0.5, 0.5);
    // What is not above the floor is the square beyond (1, 1).
    const double off = std::hypot(std::max(1 - middle.x, 0.0), std::max(1 - middle.y, 0.0));
    EXPECT_EQ(receiver.measures(cell), off >= 0.2) << middle.x << ' ' << middle.y;
  }
}

TEST(SurfaceGrid, TheBorderIsAroundSmallHoles) {
  // A square of 4 m with a hole of 0.1 m in its middle, as four trapezia.
  const double low = 1.95, high = 2.05;
  const std::vector<Polygon> floor{{{0, 0, 0}, {4, 0, 0}, {high, low, 0}, {low, low, 0}},
                                   {{4, 0, 0}, {4, 4, 0}, {high, high, 0}, {high, low, 0}},
                                   {{4, 4, 0}, {0, 4, 0}, {low, high, 0}, {high, high, 0}},
                                   {{0, 4, 0}, {0, 0, 0}, {low, low, 0}, {low, high, 0}}};
  SurfaceGrid grid = upwards();
  grid.border = 0.5;
  Receiver receiver;
  receiver.columns = receiver.rows = 31;
  ASSERT_EQ(lay_on_surface(floor, grid, receiver), std::nullopt);
  for (std::size_t cell = 0; cell < receiver.size(); ++cell) {
    const glm::dvec3 middle = receiver.place(cell, 0.5, 0.5);
    const double x = std::max(std::abs(middle.x - 2) - 0.05, 0.0),
                 y = std::max(std::abs(middle.y - 2) - 0.05, 0.0);
    EXPECT_EQ(receiver.measures(cell), std::hypot(x, y) >= 0.5) << middle.x << ' ' << middle.y;
  }
}

TEST(SurfaceGrid, LiesAlongTheOutlineOfTriangles) {
  const std::vector<Polygon> floor{{{0, 0, 0}, {7.3, 0, 0}, {7.3, 4.1, 0}},
                                   {{0, 0, 0}, {7.3, 4.1, 0}, {0, 4.1, 0}}};
  Receiver receiver;
  receiver.columns = receiver.rows = 33;
  ASSERT_EQ(lay_on_surface(floor, upwards(), receiver), std::nullopt);
  EXPECT_TRUE(receiver.unmeasured.empty());
  EXPECT_NEAR(std::max(std::abs(receiver.u.x), std::abs(receiver.v.x)), 7.3, 1e-9);
}

TEST(SurfaceGrid, NoCellFallsBetweenPolygons) {
  // A fan whose edges pass through middles of cells, turned so that its corners are rounded.
  const glm::dvec3 x(std::cos(0.3), std::sin(0.3), 0), y(-x.y, x.x, 0);
  const auto at = [&](double a, double b) { return a * x + b * y; };
  const Polygon outline{at(0, 0), at(1, 0), at(2, 0), at(2, 1), at(2, 2), at(1, 2), at(0, 2), at(0, 1)};
  std::vector<Polygon> fan;
  for (std::size_t k = 0; k < outline.size(); ++k)
    fan.push_back({at(1, 1), outline[k], outline[(k + 1) % outline.size()]});
  for (const int cells : {9, 33, 50, 101}) {
    Receiver receiver;
    receiver.columns = receiver.rows = cells;
    ASSERT_EQ(lay_on_surface(fan, upwards(), receiver), std::nullopt);
    EXPECT_TRUE(receiver.unmeasured.empty()) << cells;
  }
}

TEST(SurfaceGrid, SaysWhatIsWrong) {
  Receiver receiver;
  const Polygon wall{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}};
  EXPECT_EQ(*lay_on_surface(std::vector<Polygon>{kFloor, wall}, upwards(), receiver), "is not flat");
  SurfaceGrid sideways = upwards();
  sideways.normal = {1, 0, 0.1};
  EXPECT_NE(lay_on_surface(std::vector<Polygon>{kFloor}, sideways, receiver)->find("normal"),
            std::string::npos);
  SurfaceGrid wide = upwards();
  wide.border = 1;
  EXPECT_NE(lay_on_surface(std::vector<Polygon>{kFloor}, wide, receiver)->find("leaves nothing"),
            std::string::npos);
  SurfaceGrid fine = upwards();
  fine.spacing = 1e-9;
  EXPECT_NE(lay_on_surface(std::vector<Polygon>{kFloor}, fine, receiver)->find("too many"),
            std::string::npos);
  fine.spacing = 1e-4;
  EXPECT_NE(lay_on_surface(std::vector<Polygon>{kFloor}, fine, receiver)->find("more than"),
            std::string::npos);
}

}  // namespace
}  // namespace fluxel
