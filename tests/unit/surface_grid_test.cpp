#include "scene/surface_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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
    const glm::dvec2 past(std::max(0.0, 1 - middle.x), std::max(0.0, 1 - middle.y));
    if (!receiver.measures(cell)) continue;
    EXPECT_TRUE(middle.x < 0.8 + 1e-9 || middle.y < 0.8 + 1e-9 || glm::length(past) > 0.19) << middle.x;
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
