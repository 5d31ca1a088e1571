#include "mpi_master/steps/visibility_job.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/hash.hpp"
#include "mpi_master/communication/row_parts.hpp"
#include "mpi_master/scheduling/strip_scheduler.hpp"
#include "mpi_master/steps/deal_rows.hpp"
#include "mpi_master/steps/forecast.hpp"
#include "mpi_master/steps/subdivision_job.hpp"
#include "small_scenes.hpp"
#include "visibility/tile_tracer.hpp"
#include "world.hpp"

namespace fluxel::test {
namespace {

/// About what a tile of these scenes takes to trace.
constexpr double kSecondsATile = 1e-4;

/// A tile without what stands beyond the last element.
TileBits logical(TileBits bits, std::size_t row, std::size_t column, std::size_t elements) {
  for (std::size_t r = 0; r < kTileSize; ++r)
    bits[r] = r < rows_of_tile(row, elements) ? bits[r] & low_bits(rows_of_tile(column, elements)) : 0;
  return bits;
}

/// All tiles traced by one rank, one after another.
struct SerialVisibility {
  std::size_t elements, tiles;
  std::vector<TileBits> bits;  ///< tile (row, column >= row), row after row
  std::uint64_t rays = 0;

  SerialVisibility(const RayScene& ray_scene, std::span<const Element> all)
      : elements(all.size()), tiles(tile_count(all.size())) {
    const TileTracer tracer(ray_scene, all);
    for (std::size_t row = 0; row < tiles; ++row) {
      for (std::size_t column = row; column < tiles; ++column) {
        const TracedTile tile = tracer.trace(row, column);
        bits.push_back(logical(tile.bits, row, column, elements));
        rays += tile.rays;
      }
    }
  }

  [[nodiscard]] TileBits tile(std::size_t row, std::size_t column) const {
    const std::size_t low = std::min(row, column), high = std::max(row, column);
    TileBits found = bits[low * tiles - low * (low + 1) / 2 + high];
    if (column < row) transpose(found);
    return found;
  }

  /// A hash for each tile row, its tiles ascending from the diagonal, then of all of these.
  [[nodiscard]] std::uint64_t hash() const {
    std::vector<std::uint64_t> rows;
    for (std::size_t row = 0; row < tiles; ++row) {
      rows.push_back(0);
      for (std::size_t column = row; column < tiles; ++column) {
        const TileBits found = tile(row, column);
        rows.back() = hash_bytes(std::as_bytes(std::span(found)), rows.back());
      }
    }
    return hash_bytes(std::as_bytes(std::span(rows)));
  }
};

/// The store has the tiles of the rows that this rank owns, bit by bit.
void expect_own_rows(const Visibility& visibility, const SerialVisibility& serial) {
  const TileRows own = visibility.owners.rows(world().rank());
  EXPECT_EQ(visibility.store.owned().first, own.first);
  EXPECT_EQ(visibility.store.owned().last, own.last);
  std::size_t differing = 0;
  for (std::size_t row = own.first; row < own.last; ++row) {
    for (std::size_t column = 0; column < serial.tiles; ++column) {
      TileBits bits;
      visibility.store.read(row, column, bits);
      if (logical(bits, row, column, serial.elements) != serial.tile(row, column)) ++differing;
    }
  }
  EXPECT_EQ(differing, 0u) << "tiles";
}

void check_equal_to_serial(const SolveRequest& request) {
  const Scene scene = scene_of(request);
  const SubdividedScene subdivided = subdivide_scene(world(), scene, request.options, 1);
  const std::span<const Element> elements = subdivided.mesh.elements;
  const RayScene ray_scene(scene, 1);
  const SerialVisibility serial(ray_scene, elements);
  for (const int threads : {1, 2}) {
    SilentProgress progress;
    const Visibility visibility =
        compute_visibility({world(), threads, progress}, TileTracer(ray_scene, elements),
                           RowCosts::even(serial.tiles, kSecondsATile));
    expect_own_rows(visibility, serial);
    EXPECT_EQ(visibility.hash, serial.hash());
    EXPECT_EQ(visibility.counts.rays, serial.rays) << "each pair is traced once";
    EXPECT_EQ(visibility.counts.tiles_uniform + visibility.counts.tiles_mixed, serial.bits.size());
    std::uint64_t bytes = visibility.store.bytes();
    world().all_sum(std::span(&bytes, 1));
    EXPECT_EQ(visibility.counts.store_bytes, bytes);
  }
}

TEST(VisibilityJob, EqualsTracingTileAfterTile) {
  for (const NamedRequest& named : small_requests()) {
    SCOPED_TRACE(named.name);
    check_equal_to_serial(named.request);
  }
}

/// Of the rank that has most, over the mean: tiles with light of its rows, and a little for the others.
double largest_share(const Visibility& visibility, const SerialVisibility& serial) {
  double all = 0, most = 0;
  for (int rank = 0; rank < visibility.owners.ranks(); ++rank) {
    double own = 0;
    const TileRows rows = visibility.owners.rows(rank);
    for (std::size_t row = rows.first; row < rows.last; ++row)
      for (std::size_t column = 0; column < serial.tiles; ++column)
        own += serial.tile(row, column) == TileBits{} ? 0.02 : 1.0;
    all += own;
    most = std::max(most, own);
  }
  return most * visibility.owners.ranks() / all;
}

TEST(DealRows, TilesComeToWhoHasAsMuchToDoAsOthers) {
  const SolveRequest request = scene_request("corridor", {"--subdivision", "uniform", "--max-edge", "0.12"});
  const Scene scene = scene_of(request);
  const SubdividedScene subdivided = subdivide_scene(world(), scene, request.options, 1);
  const std::span<const Element> elements = subdivided.mesh.elements;
  const RayScene ray_scene(scene, 1);
  const SerialVisibility serial(ray_scene, elements);
  ASSERT_GT(serial.tiles, 40u);
  // The first rows seem to cost much more than the last, so that the last rank has far too many.
  RowCosts costs = RowCosts::even(serial.tiles, kSecondsATile);
  for (std::size_t row = 0; row < serial.tiles; ++row)
    costs.solve[row] = std::exp(-4.0 * static_cast<double>(row) / static_cast<double>(serial.tiles));
  SilentProgress progress;
  Visibility visibility = compute_visibility({world(), 1, progress}, TileTracer(ray_scene, elements), costs);
  const double before = largest_share(visibility, serial);
  deal_rows(world(), visibility);
  const double after = largest_share(visibility, serial);
  if (ranks() > 1) {
    EXPECT_GT(before, 1.4);
  }
  EXPECT_LT(after, 1.25) << "tiles with bits take a little longer than those without";
  expect_own_rows(visibility, serial);
  EXPECT_EQ(visibility.store.held(), visibility.store.expected());
}

TEST(VisibilityJob, SerialReferenceSeesBothAnswers) {
  // Else the comparison above would say nothing.
  const SolveRequest request = scene_request("cornell-box", {"--resolution", "24x24"});
  const Scene scene = scene_of(request);
  const SubdividedScene subdivided = subdivide_scene(world(), scene, request.options, 1);
  const SerialVisibility serial(RayScene(scene, 1), subdivided.mesh.elements);
  std::size_t seen = 0;
  for (const TileBits& bits : serial.bits)
    for (const std::uint64_t word : bits) seen += static_cast<std::size_t>(std::popcount(word));
  const std::size_t pairs = serial.elements * (serial.elements - 1) / 2;
  EXPECT_GT(seen, pairs / 10);
  EXPECT_LT(seen, pairs);
  EXPECT_NE(serial.elements % kTileSize, 0u) << "the last tile must not be full";
  EXPECT_GT(serial.tiles, 7u) << "every rank of seven must own some";
}

TEST(VisibilityJob, StripsOfSeveralRowsEqualTracingTileAfterTile) {
  const SolveRequest request = scene_request("cornell-box", {"--resolution", "64x64"});
  check_equal_to_serial(request);
  const Scene scene = scene_of(request);
  const std::size_t tiles =
      tile_count(subdivide_scene(world(), scene, request.options, 1).mesh.elements.size());
  const RowCosts costs = RowCosts::even(tiles, kSecondsATile);
  const TileRange strip = StripScheduler(RowOwners(costs.solve, 1), costs.trace, 8e-3).next(0).value();
  EXPECT_GT(strip.size(), tiles) << "on a single rank";
}

TEST(VisibilityJob, EveryMomentOfARankIsAccountedFor) {
  const SolveRequest request = scene_request("cornell-box", {"--resolution", "64x64"});
  const Scene scene = scene_of(request);
  const SubdividedScene subdivided = subdivide_scene(world(), scene, request.options, 1);
  const std::span<const Element> elements = subdivided.mesh.elements;
  const RayScene ray_scene(scene, 1);
  const std::size_t tiles = tile_count(elements.size());
  SilentProgress progress;
  const ScheduleRecord schedule = compute_visibility({world(), 1, progress}, TileTracer(ray_scene, elements),
                                                     RowCosts::even(tiles, kSecondsATile))
                                      .schedule;
  ASSERT_EQ(schedule.of_ranks.size(), ranks());
  std::uint64_t computed = 0, sent = 0;
  for (std::size_t rank = 0; rank < ranks(); ++rank) {
    const Activity& activity = schedule.of_ranks[rank];
    computed += activity.tiles;
    sent += activity.bytes_sent;
  }
  const Activity& own = schedule.of_ranks[own_rank()];
  double in_spans = 0, end = 0;
  for (const ActivitySpan& span : schedule.timeline) {
    EXPECT_EQ(span.rank, world().rank());
    EXPECT_DOUBLE_EQ(span.start, end) << "spans follow one another";
    in_spans += span.end - span.start;
    end = span.end;
  }
  EXPECT_NEAR(in_spans, own.busy_seconds + own.message_seconds + own.waiting_seconds, 1e-6);
  EXPECT_GT(in_spans, 0);
  EXPECT_EQ(computed, TileTriangle(tiles).size());
  if (ranks() == 1) {
    EXPECT_EQ(sent, 0u);
  } else {
    EXPECT_GT(sent, computed / ranks()) << "a byte for each tile that has two owners, and strips";
  }
}

TEST(RowParts, ARangeIsCutAtItsRows) {
  const TileTriangle triangle(6);
  EXPECT_EQ(row_parts(triangle, {11, 14}), (std::vector<RowPart>{{2, 2, 5, 0}}));
  EXPECT_EQ(row_parts(triangle, {14, 20}), (std::vector<RowPart>{{2, 5, 6, 0}, {3, 3, 6, 1}, {4, 4, 6, 4}}));
  EXPECT_EQ(row_parts(triangle, {20, 21}), (std::vector<RowPart>{{5, 5, 6, 0}}));
  EXPECT_TRUE(row_parts(triangle, {21, 21}).empty());
}

TEST(Forecast, BytesOfTheStoresAreNear) {
  const SolveRequest request = scene_request("cornell-box", {"--resolution", "80x80"});
  const Scene scene = scene_of(request);
  const SubdividedScene subdivided = subdivide_scene(world(), scene, request.options, 1);
  const std::span<const Element> elements = subdivided.mesh.elements;
  const RayScene ray_scene(scene, 1);
  const TileTracer tracer(ray_scene, elements);
  const Forecast predicted = forecast(world(), tracer, elements.size(), 1);
  const Forecast dry = forecast(world(), tracer, elements.size(), 1, SampleUse::totals);
  SilentProgress progress;
  const Visibility visibility = compute_visibility({world(), 1, progress}, tracer, predicted.costs);
  const double ratio =
      static_cast<double>(predicted.store_bytes) / static_cast<double>(visibility.counts.store_bytes);
  EXPECT_NEAR(ratio, 1, 0.15);
  EXPECT_NEAR(static_cast<double>(dry.store_bytes) / static_cast<double>(predicted.store_bytes), 1, 0.1);
  const double mixed = static_cast<double>(visibility.counts.tiles_mixed) /
                       static_cast<double>(visibility.counts.tiles_mixed + visibility.counts.tiles_uniform);
  EXPECT_NEAR(predicted.mixed_tiles, mixed, 0.05);
  EXPECT_NEAR(dry.mixed_tiles, mixed, 0.05);
  EXPECT_GT(visibility.counts.tiles_mixed, 2048u) << "a sample of the tiles must have to do";
}

TEST(Forecast, WhatAHostSharesIsCountedOnce) {
  const SolveRequest request = scene_request("cornell-box", {"--resolution", "80x80"});
  const Scene scene = scene_of(request);
  const RayScene ray_scene(scene, 1);
  const auto forecast_on = [&](const Communicator& ranks) {
    const SubdividedScene subdivided = subdivide_scene(ranks, scene, request.options, 1);
    const TileTracer tracer(ray_scene, subdivided.mesh.elements);
    const std::uint64_t least = least_bytes(ranks, tracer.elements());
    return std::pair(forecast(ranks, tracer, tracer.elements(), 1).to_come, least);
  };
  const auto together = forecast_on(world().ordered_by_hosts(0));
  const auto apart = forecast_on(world().ordered_by_hosts(world().rank()));
  if (ranks() == 1) {
    EXPECT_EQ(together, apart);
    return;
  }
  // A rank's part of the power of the columns, and of what a leader holds in the end, not a set of them.
  const std::size_t elements = subdivide_scene(world(), scene, request.options, 1).mesh.elements.size();
  const double shared = 140 * static_cast<double>(elements) * (1 - 1.2 / static_cast<double>(ranks()));
  EXPECT_LT(static_cast<double>(together.first) + shared, static_cast<double>(apart.first));
  EXPECT_LT(static_cast<double>(together.second) + shared, static_cast<double>(apart.second));
}

}  // namespace
}  // namespace fluxel::test
