#include "formfactor/row_sum_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/closed_forms/shapes.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

// A room that a box stands in, of which a pair may be lost.
TEST(RowSumCheck, WhatRaysSeeIsNotMissing) {
  SceneInput input;
  input.materials = {{"black", Rgb(0), Rgb(0), std::nullopt, std::nullopt}};
  const auto add = [&](const std::vector<closed_forms::Polygon>& faces) {
    for (const closed_forms::Polygon& face : faces) {
      const auto number = static_cast<std::uint32_t>(input.groups.size());
      input.groups.push_back(std::to_string(number));
      input.polygons.push_back({face, MaterialId{0}, GroupId{number}});
    }
  };
  add(closed_forms::reversed(closed_forms::box({0, 0, 0}, {4, 3, 2.5})));
  add(closed_forms::box({1, 1, 0}, {2, 2, 1}));
  SceneSettings settings{Sides::one, KeMeaning::exitance, true, std::nullopt};
  settings.seal = false;
  const Scene scene = build_scene(input, settings);
  const RayScene ray_scene(scene, 1);
  const FacePairs pairs(ray_scene, scene, 1e-3);
  std::vector<SurfaceExchange> list;
  for (std::size_t row = 0; row < pairs.rows(); ++row)
    for (const SurfaceExchange& entry : pairs.examine_row(row).list) list.push_back(entry);
  list = sum_by_surfaces(std::move(list));
  const std::vector<double> areas = pairs.surface_areas();
  EXPECT_TRUE(doubtful_rows(ray_scene, {list, areas}).empty());
  const SurfaceExchange lost = list[list.size() / 2];
  ASSERT_GT(lost.G, 0.02 * areas[lost.from]);
  std::erase_if(list, [&](const SurfaceExchange& of) { return of.from == lost.from && of.to == lost.to; });
  const std::vector<DoubtfulRow> found = doubtful_rows(ray_scene, {list, areas});
  ASSERT_EQ(found.size(), 2u);
  for (const std::uint32_t surface : {lost.from, lost.to})
    EXPECT_EQ(std::ranges::count(found, surface, &DoubtfulRow::surface), 1) << surface;
}

}  // namespace
}  // namespace fluxel
