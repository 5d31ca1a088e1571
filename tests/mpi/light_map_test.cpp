#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>
#include <vector>

#include "core/error.hpp"
#include "method/light_map_layout.hpp"
#include "method/light_map_points.hpp"
#include "method/rectangle_packing.hpp"
#include "scene/polygon.hpp"
#include "tests/mpi/small_scenes.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {
namespace {

TEST(RectanglePacking, PlacesAllWithoutOverlaps) {
  std::vector<PackedRectangle> rectangles;
  for (int k = 0; k < 300; ++k) rectangles.push_back({1 + k * 7 % 20, 1 + k * 11 % 19});
  ASSERT_TRUE(pack(rectangles, 256, 256));
  std::vector<int> taken(256 * 256, 0);
  for (const PackedRectangle& of : rectangles) {
    ASSERT_GE(std::min(of.x, of.y), 0);
    ASSERT_LE(std::max(of.x + of.width, of.y + of.height), 256);
    for (int y = of.y; y < of.y + of.height; ++y)
      for (int x = of.x; x < of.x + of.width; ++x) ++taken[static_cast<std::size_t>(256 * y + x)];
  }
  EXPECT_EQ(*std::ranges::max_element(taken), 1);
  EXPECT_FALSE(pack(rectangles, 128, 128));
}

/// A floor in the shape of an L, of two rectangles that share a part of an edge, and a lamp above it.
SolveRequest bent_floor() {
  SolveRequest request = test::two_squares();
  request.input.polygons[0].corners = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
  request.input.polygons.push_back(
      {{{0, 1, 0}, {1, 1, 0}, {1, 1.53, 0}, {0, 1.53, 0}}, MaterialId{0}, GroupId{0}});
  return request;
}

TEST(LightMapLayout, PiecesOfOnePlaneShareALattice) {
  const Scene scene = test::scene_of(bent_floor());
  const LightMapLayout layout = lay_out(scene, 0.11);
  ASSERT_EQ(layout.charts.size(), scene.pieces.size());
  std::set<std::uint32_t> of_floor;
  for (const LightMapChart& chart : layout.charts) {
    const Piece& piece = scene.pieces[chart.piece];
    if (scene.patch(piece.patch).normal.z > 0) of_floor.insert(chart.lattice);
    const TexelLattice& lattice = layout.lattices[chart.lattice];
    EXPECT_NEAR(glm::dot(lattice.normal, scene.patch(piece.patch).normal), 1, 1e-12);
    EXPECT_NEAR(glm::distance(glm::cross(lattice.v, lattice.u), lattice.normal), 0, 1e-12);
    EXPECT_LE(std::max(lattice.step.x, lattice.step.y), 0.11);
    EXPECT_GE(std::min(lattice.step.x, lattice.step.y), 0.055);
    // All corners lie among the middles of the chart's texels.
    for (const glm::dvec3& corner : corners(piece.outline)) {
      const glm::dvec2 place = layout.place(chart, corner) - glm::dvec2(chart.place) - 0.5;
      EXPECT_GE(std::min(place.x, place.y), -1e-5);
      EXPECT_LE(std::max(place.x - chart.texels.x, place.y - chart.texels.y), -1 + 1e-5);
    }
  }
  EXPECT_EQ(of_floor.size(), 1U);
}

TEST(LightMapLayout, ChartsKeepTheirPadding) {
  const Scene scene = test::scene_of(test::scene_request("cornell-box", {"--resolution", "16x16"}));
  for (const std::optional<double> texel : {std::optional<double>(0.01), std::optional<double>()}) {
    const LightMapLayout layout = lay_out(scene, texel);
    if (!texel) {
      EXPECT_EQ(layout.width, 1024);
    }
    std::vector<int> taken(static_cast<std::size_t>(layout.width) * static_cast<std::size_t>(layout.height),
                           0);
    for (const LightMapChart& chart : layout.charts)
      for (int y = -kLightMapPadding; y < chart.texels.y + kLightMapPadding; ++y)
        for (int x = -kLightMapPadding; x < chart.texels.x + kLightMapPadding; ++x)
          ++taken.at(static_cast<std::size_t>((chart.place.y + y) * layout.width + chart.place.x + x));
    EXPECT_EQ(*std::ranges::max_element(taken), 1);
    EXPECT_GT(std::ranges::count(taken, 1), 0.4 * static_cast<double>(taken.size())) << "room is used";
  }
}

TEST(LightMapLayout, RefusesWhatHasNoRoom) {
  const Scene scene = test::scene_of(test::two_squares());
  for (const double texel : {1e-4, 1e-9, 1e-300})
    EXPECT_THROW(static_cast<void>(lay_out(scene, texel)), InputError);
  const LightMapLayout layout = lay_out(scene, 1e9);
  EXPECT_LE(layout.width, 16);
}

TEST(LightMapPoints, NeighboursShareTexelsAndAllLieInside) {
  const Scene scene = test::scene_of(bent_floor());
  const RayScene ray_scene(scene, 1);
  const NodeTree tree(scene);
  const LightMapLayout layout = lay_out(scene, 0.11);
  const LightMapPoints points = points_of(layout, tree, ray_scene);
  for (const GatherPoint& point : points.points) {
    const Piece& piece = scene.pieces[tree[point.face].piece];
    const PolygonView outline = corners(piece.outline);
    for (std::size_t edge = 0; edge < outline.size(); ++edge)
      EXPECT_GT(edge_plane(outline, edge, scene.patch(piece.patch).normal).distance(point.position), 1e-3);
  }
  // Charts of the floor show the same points at the same texels of the lattice.
  const auto point_at = [&](const LightMapChart& chart, const glm::i64vec2& of_lattice) {
    const glm::i64vec2 at = of_lattice - chart.first;
    if (at.x < 0 || at.y < 0 || at.x >= chart.texels.x || at.y >= chart.texels.y) return LightMap::kNone;
    return points
        .point[static_cast<std::size_t>((chart.place.y + at.y) * layout.width + chart.place.x + at.x)];
  };
  std::size_t shared = 0;
  for (const LightMapChart& one : layout.charts)
    for (const LightMapChart& other : layout.charts) {
      if (&one == &other || one.lattice != other.lattice) continue;
      for (int y = 0; y < one.texels.y; ++y)
        for (int x = 0; x < one.texels.x; ++x) {
          const glm::i64vec2 of_lattice = one.first + glm::i64vec2(x, y);
          const std::uint32_t a = point_at(one, of_lattice), b = point_at(other, of_lattice);
          if (a == LightMap::kNone || b == LightMap::kNone) continue;
          EXPECT_EQ(a, b);
          ++shared;
        }
    }
  EXPECT_GE(shared, 20U) << "a row along a metre, told twice";
}

// Down to the floor, and ending a millimetre above it, which light hardly passes.
TEST(LightMapPoints, NothingIsSharedAcrossAWall) {
  for (const double gap : {0.0, 1e-3}) {
    SolveRequest request = test::two_squares();
    // Across the middle of the floor, as wide as it is.
    request.input.polygons.push_back(
        {{{0.5, 0, gap}, {0.5, 1, gap}, {0.5, 1, 1}, {0.5, 0, 1}}, MaterialId{0}, GroupId{0}});
    const Scene scene = test::scene_of(request);
    const RayScene ray_scene(scene, 1);
    const NodeTree tree(scene);
    const LightMapLayout layout = lay_out(scene, 0.03);
    const LightMapPoints points = points_of(layout, tree, ray_scene);
    std::size_t on_floor = 0;
    for (std::size_t texel = 0; texel < points.chart.size(); ++texel) {
      if (points.chart[texel] == LightMap::kNone) continue;
      const LightMapChart& chart = layout.charts[points.chart[texel]];
      const Piece& piece = scene.pieces[chart.piece];
      if (scene.patch(piece.patch).normal.z < 0.5) continue;
      const double wall = 0.5 - scene.origin.x;
      EXPECT_EQ(centroid(corners(piece.outline)).x < wall,
                points.points[points.point[texel]].position.x < wall);
      ++on_floor;
    }
    EXPECT_GT(on_floor, 1000U);
  }
}

// However large its texels are.
TEST(LightMapPoints, ASheetCloselyAboveAFloorHasPointsOfItsOwn) {
  SolveRequest request = test::two_squares();
  request.input.polygons.push_back(
      {{{0.2, 0.2, 1e-4}, {0.7, 0.2, 1e-4}, {0.7, 0.7, 1e-4}, {0.2, 0.7, 1e-4}}, MaterialId{0}, GroupId{0}});
  const Scene scene = test::scene_of(request);
  const RayScene ray_scene(scene, 1);
  const NodeTree tree(scene);
  for (const double texel : {0.07, 0.5, 20.0}) {
    const LightMapLayout layout = lay_out(scene, texel);
    const LightMapPoints points = points_of(layout, tree, ray_scene);
    for (std::size_t at = 0; at < points.chart.size(); ++at)
      if (points.chart[at] != LightMap::kNone) {
        const glm::dvec3& corner = scene.pieces[layout.charts[points.chart[at]].piece].outline.corner[0];
        EXPECT_NEAR(points.points[points.point[at]].position.z, corner.z, 1e-6);
      }
  }
}

}  // namespace
}  // namespace fluxel
