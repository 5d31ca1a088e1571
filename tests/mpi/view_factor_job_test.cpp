#include "mpi_master/steps/view_factor_job.hpp"
#include "core/options.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "small_scenes.hpp"
#include "world.hpp"

namespace fluxel::test {
namespace {

/// All rows one after another, by this rank alone.
std::vector<SurfaceExchange> serial(const FacePairs& pairs) {
  std::vector<SurfaceExchange> all;
  for (std::size_t row = 0; row < pairs.rows(); ++row)
    for (const SurfaceExchange& entry : pairs.examine_row(row).list) all.push_back(entry);
  return sum_by_surfaces(std::move(all));
}

void expect_equal(const std::vector<SurfaceExchange>& found, const std::vector<SurfaceExchange>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_EQ(found[k].from, expected[k].from);
    EXPECT_EQ(found[k].to, expected[k].to);
    EXPECT_EQ(found[k].G, expected[k].G);
    EXPECT_EQ(found[k].error, expected[k].error);
    EXPECT_EQ(found[k].deviation, expected[k].deviation);
  }
}

/// As serial on the root, nothing elsewhere, whatever the number of ranks and threads.
void check_equal_to_serial(const Scene& scene, double tolerance) {
  const RayScene ray_scene(scene, 2);
  const FacePairs pairs(ray_scene, scene, tolerance);
  const std::vector<SurfaceExchange> expected =
      world().is_root() ? serial(pairs) : std::vector<SurfaceExchange>{};
  for (const int threads : {1, 2}) {
    SilentProgress progress;
    SCOPED_TRACE(threads);
    expect_equal(exchange_of_surfaces(world(), pairs, threads, progress).list, expected);
  }
}

TEST(ViewFactorJob, EqualsRowAfterRow) {
  const Scene scene = scene_of(scene_request("cornell-box", {"--resolution", "24x24"}));
  const RayScene ray_scene(scene, 1);
  const FacePairs pairs(ray_scene, scene, 1e-2);
  ASSERT_GT(pairs.rows(), 1u);
  const std::vector<SurfaceExchange> expected = serial(pairs);
  EXPECT_TRUE(std::ranges::any_of(expected, [](const SurfaceExchange& entry) { return entry.deviation > 0; }))
      << "some pairs must be partly hidden";
  check_equal_to_serial(scene, 1e-2);
}

// More rows than ranks, rows that are shared out unevenly, a last row that is not full.
TEST(ViewFactorJob, ManyRows) {
  SolveRequest request;
  SceneInput& input = request.input;
  input.name = "plates";
  input.materials = {{"black", Rgb(0), Rgb(0), std::nullopt, std::nullopt}};
  for (std::uint32_t group = 0; group < 5; ++group) input.groups.push_back("plates " + std::to_string(group));
  for (std::uint32_t k = 0; k < 170; ++k) {
    const double x = 0.3 * (k % 17), y = 0.3 * (k / 17), z = 0.1 * (k * 7 % 10);
    input.polygons.push_back(
        {{{x, y, z}, {x + 0.2, y, z}, {x + 0.2, y + 0.1, z + 0.2}, {x, y + 0.1, z + 0.2}},
         MaterialId{0},
         GroupId{k % 5}});
  }
  request.options.sides = Sides::two;
  const Scene scene = scene_of(request);
  {
    const RayScene ray_scene(scene, 1);
    const FacePairs pairs(ray_scene, scene, 0.1);
    EXPECT_GT(pairs.rows(), 7u);
    EXPECT_NE(pairs.faces() % 32, 0u);
  }
  check_equal_to_serial(scene, 0.1);
}

TEST(ViewFactorJob, FewerRowsThanRanks) {
  const Scene scene = scene_of(two_squares());
  check_equal_to_serial(scene, 1e-4);
  const RayScene ray_scene(scene, 1);
  SilentProgress progress;
  EXPECT_EQ(exchange_of_surfaces(world(), FacePairs(ray_scene, scene, 1e-4), 1, progress).list.size(),
            world().is_root() ? 1u : 0u);
}

TEST(ViewFactorJob, NothingExchanged) {
  SolveRequest request = two_squares();
  request.input.polygons.pop_back();
  check_equal_to_serial(scene_of(request), 1e-4);
}

}  // namespace
}  // namespace fluxel::test
