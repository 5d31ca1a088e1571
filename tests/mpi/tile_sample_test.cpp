#include "mpi_master/scheduling/tile_sample.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "core/hash.hpp"
#include "mpi_master/steps/subdivision_job.hpp"
#include "small_scenes.hpp"
#include "visibility/tile_code.hpp"
#include "visibility/tile_range.hpp"
#include "visibility/tile_store.hpp"
#include "world.hpp"

namespace fluxel::test {
namespace {

TEST(TileSample, WholeOfASmallMatrixIsCountedExactly) {
  const SolveRequest request = scene_request("cornell-box", {"--resolution", "24x24"});
  const Scene scene = scene_of(request);
  const SubdividedScene subdivided = subdivide_scene(world(), scene, request.options, 1);
  const std::span<const Element> elements = subdivided.mesh.elements;
  const RayScene ray_scene(scene, 1);
  const TileTracer tracer(ray_scene, elements);
  const TileTriangle triangle(tile_count(elements.size()));
  ASSERT_LE(triangle.size(), 1024u) << "a round holds them all";

  const TileSample sample = sample_tiles(world(), tracer, 1);
  // One tile of each of as many parts as there are tiles, as long as the bytes are not known well enough.
  ASSERT_EQ(sample.tiles % triangle.size(), 0u);
  std::uint64_t mixed = 0;
  double bytes = 0;
  for (std::uint64_t number = 0; number < triangle.size(); ++number) {
    const std::size_t row = triangle.row_of(number);
    const TracedTile tile = tracer.trace(row, triangle.column_of(row, number));
    if (tile.tag != TileTag::bits) continue;
    ++mixed;
    bytes += static_cast<double>(TileStore::pool_bytes(encode_tile(tile.bits).size));
  }
  EXPECT_EQ(sample.mixed * triangle.size(), mixed * sample.tiles);
  // Rows are told apart in parts at most: the mean over all of them is that of all tiles, seen from both
  // sides.
  const std::vector<double>& rows = sample.costs.bytes;
  ASSERT_EQ(rows.size(), triangle.side());
  EXPECT_NEAR(std::accumulate(rows.begin(), rows.end(), 0.0) / static_cast<double>(rows.size()),
              bytes / static_cast<double>(triangle.size()),
              0.15 * bytes / static_cast<double>(triangle.size()));
  EXPECT_GT(std::accumulate(sample.costs.trace.begin(), sample.costs.trace.end(), 0.0), 0);
}

TEST(TileSample, AllRanksKnowTheSameCosts) {
  const SolveRequest request = scene_request("cornell-box", {"--resolution", "64x64"});
  const Scene scene = scene_of(request);
  const SubdividedScene subdivided = subdivide_scene(world(), scene, request.options, 1);
  const std::span<const Element> elements = subdivided.mesh.elements;
  const RayScene ray_scene(scene, 1);
  const TileSample sample = sample_tiles(world(), TileTracer(ray_scene, elements), 1);
  for (const std::vector<double>* costs : {&sample.costs.trace, &sample.costs.solve, &sample.costs.bytes}) {
    EXPECT_EQ(costs->size(), tile_count(elements.size()));
    EXPECT_GE(*std::ranges::min_element(*costs), 0);
    const std::uint64_t own = hash_bytes(std::as_bytes(std::span(*costs)));
    for (const std::uint64_t hash : world().all_gather(std::span(&own, 1))) EXPECT_EQ(hash, own);
  }
  EXPECT_GT(sample.share_of_processor, 0);
  EXPECT_LE(sample.share_of_processor, 1);
}

TEST(TileSample, TotalsTakeFewTilesWhateverTheRows) {
  const SolveRequest request =
      scene_request("cornell-box", {"--subdivision", "uniform", "--max-edge", "0.008"});
  const Scene scene = scene_of(request);
  const SubdividedScene subdivided = subdivide_scene(world(), scene, request.options, 1);
  const RayScene ray_scene(scene, 1);
  const TileTracer tracer(ray_scene, subdivided.mesh.elements);
  const TileSample shares = sample_tiles(world(), tracer, 1);
  const TileSample totals = sample_tiles(world(), tracer, 1, SampleUse::totals);
  EXPECT_LE(totals.tiles, 8192u);
  EXPECT_GT(shares.tiles, 2 * totals.tiles);
  // With an entry of the table, as the sample's own error is measured.
  const auto bytes = [](const TileSample& sample) {
    const std::vector<double>& rows = sample.costs.bytes;
    return 4 + std::accumulate(rows.begin(), rows.end(), 0.0) / static_cast<double>(rows.size());
  };
  EXPECT_NEAR(bytes(totals) / bytes(shares), 1, 0.1);
}

}  // namespace
}  // namespace fluxel::test
