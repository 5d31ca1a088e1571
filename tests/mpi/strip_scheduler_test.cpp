#include "mpi_master/scheduling/strip_scheduler.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <random>

#include "mpi_master/scheduling/tile_sample.hpp"

namespace fluxel::test {
namespace {

constexpr double kTileSeconds = 1e-3;
constexpr double kMinCost = 8e-3;
constexpr std::size_t kSizes[] = {0, 1, 2, 3, 5, 7, 31, 32, 33, 64, 100, 257};

/// Costs of rows that differ by up to a thousand times, and rows that cost nothing.
std::vector<double> uneven_costs(std::size_t rows) {
  std::mt19937_64 random(7);
  std::vector<double> costs;
  for (std::size_t row = 0; row < rows; ++row)
    costs.push_back(row % 5 == 3 ? 0.0 : 1e-4 * static_cast<double>(1 + random() % 1000));
  return costs;
}

double sum(std::span<const double> values) { return std::accumulate(values.begin(), values.end(), 0.0); }

TEST(TileTriangle, NumbersAndPlacesAreInverse) {
  for (const std::size_t side : kSizes) {
    const TileTriangle triangle(side);
    std::uint64_t number = 0;
    for (std::size_t row = 0; row < side; ++row) {
      EXPECT_EQ(triangle.first_of(row), number);
      for (std::size_t column = row; column < side; ++column, ++number) {
        ASSERT_EQ(triangle.number(row, column), number);
        ASSERT_EQ(triangle.row_of(number), row);
        ASSERT_EQ(triangle.column_of(row, number), column);
      }
    }
    EXPECT_EQ(triangle.size(), number);
    EXPECT_EQ(triangle.row_of(number), side) << "behind the last";
  }
}

TEST(TileTriangle, RowsAreExactWhereTheRootIsNot) {
  const TileTriangle triangle(std::size_t{3} << 30);
  for (const std::uint64_t row : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{12345678},
                                  (std::uint64_t{3} << 30) - 2, (std::uint64_t{3} << 30) - 1}) {
    EXPECT_EQ(triangle.row_of(triangle.first_of(row)), row);
    EXPECT_EQ(triangle.row_of(triangle.first_of(row + 1) - 1), row);
  }
}

TEST(RowOwners, PartsFollowOneAnotherAndOwnerIsTheInverse) {
  for (const std::size_t rows : kSizes) {
    for (const std::vector<double>& costs : {std::vector<double>(rows, 2.5), uneven_costs(rows)}) {
      for (int ranks = 1; ranks <= 16; ++ranks) {
        const RowOwners owners(costs, ranks);
        EXPECT_EQ(owners.ranks(), ranks);
        EXPECT_EQ(owners.tile_rows(), rows);
        std::size_t end = 0;
        for (int rank = 0; rank < ranks; ++rank) {
          const TileRows part = owners.rows(rank);
          EXPECT_EQ(part.first, end);
          ASSERT_LE(part.first, part.last);
          for (std::size_t row = part.first; row < part.last; ++row) ASSERT_EQ(owners.owner(row), rank);
          end = part.last;
        }
        EXPECT_EQ(end, rows) << ranks << " ranks";
      }
    }
  }
}

TEST(RowOwners, NoPartCostsARowMoreThanItsShare) {
  const std::vector<double> costs = uneven_costs(257);
  const double dearest = *std::ranges::max_element(costs);
  for (const int ranks : {1, 2, 3, 7, 16, 100, 300}) {
    const RowOwners owners(costs, ranks);
    for (int rank = 0; rank < ranks; ++rank) {
      const TileRows rows = owners.rows(rank);
      const double cost = sum(std::span(costs).subspan(rows.first, rows.size()));
      EXPECT_LE(cost, sum(costs) / ranks + dearest);
      EXPECT_GE(cost, sum(costs) / ranks - dearest);
    }
  }
}

/// A worker of a played job: seconds for a tile, and when it is gone for good.
struct ScriptedWorker {
  double seconds_a_tile = kTileSeconds;
  double dies_at = std::numeric_limits<double>::infinity();
};

struct Played {
  std::vector<TileRange> strips;   ///< finished, ascending
  std::vector<double> tiles;       ///< of each rank
  std::vector<double> busy_until;  ///< of each rank
  double end = 0;
};

/// The one that is free first asks first, as in a job; one that dies takes its strip with it.
Played play(StripScheduler& scheduler, const std::vector<ScriptedWorker>& workers) {
  Played played{{}, std::vector<double>(workers.size()), std::vector<double>(workers.size()), 0};
  std::vector<bool> dismissed(workers.size());
  while (std::ranges::count(dismissed, false) > 0) {
    std::size_t rank = 0;
    while (dismissed[rank]) ++rank;
    for (std::size_t other = rank; other < workers.size(); ++other)
      if (!dismissed[other] && played.busy_until[other] < played.busy_until[rank]) rank = other;
    const auto strip = scheduler.next(static_cast<int>(rank));
    if (!strip) {
      EXPECT_EQ(scheduler.tiles_assigned(), scheduler.tiles_to_assign()) << "dismissed while there is work";
      dismissed[rank] = true;
      continue;
    }
    EXPECT_GT(strip->size(), 0u) << "an empty strip means that there is no more";
    played.busy_until[rank] += workers[rank].seconds_a_tile * static_cast<double>(strip->size());
    if (played.busy_until[rank] > workers[rank].dies_at) {
      dismissed[rank] = true;
      continue;
    }
    played.tiles[rank] += static_cast<double>(strip->size());
    played.strips.push_back(*strip);
    played.end = std::max(played.end, played.busy_until[rank]);
  }
  std::ranges::sort(played.strips, {}, &TileRange::first);
  return played;
}

StripScheduler even_scheduler(std::size_t rows, int ranks, std::span<const TileRange> done = {}) {
  const RowCosts costs = RowCosts::even(rows, kTileSeconds);
  return StripScheduler(RowOwners(costs.solve, ranks), costs.trace, kMinCost, done);
}

/// Tiles that are in no range; ranges that overlap are an error.
std::uint64_t missing_tiles(std::span<const TileRange> ranges, std::uint64_t all) {
  std::uint64_t first = 0, missing = 0;
  for (const TileRange& range : ranges) {
    EXPECT_GE(range.first, first) << "a tile is assigned twice";
    missing += range.first - first;
    first = range.last;
  }
  return missing + all - first;
}

TEST(StripScheduler, EveryTileIsAssignedExactlyOnce) {
  const std::vector<std::vector<ScriptedWorker>> crews{
      {{1}}, {{1}, {20}}, {{20}, {1}}, {{50}, {1}, {1}, {2}}, std::vector<ScriptedWorker>(40)};
  for (const std::size_t rows : kSizes) {
    for (const auto& crew : crews) {
      const auto ranks = static_cast<int>(crew.size());
      StripScheduler even = even_scheduler(rows, ranks);
      EXPECT_EQ(missing_tiles(play(even, crew).strips, rows * (rows + 1) / 2), 0u) << rows << " rows";
      const std::vector<double> costs = uneven_costs(rows);
      StripScheduler uneven(RowOwners(costs, ranks), costs, kMinCost);
      EXPECT_EQ(missing_tiles(play(uneven, crew).strips, rows * (rows + 1) / 2), 0u) << rows << " rows";
    }
  }
}

TEST(StripScheduler, ARankBeginsWithItsOwnRows) {
  StripScheduler scheduler = even_scheduler(90, 3);
  const TileTriangle triangle(90);
  for (const int rank : {2, 0, 1}) {
    const auto strip = scheduler.next(rank);
    ASSERT_TRUE(strip);
    EXPECT_EQ(strip->first, triangle.first_of(static_cast<std::size_t>(30 * rank)));
    EXPECT_LE(strip->last, triangle.first_of(static_cast<std::size_t>(30 * (rank + 1))));
  }
}

TEST(StripScheduler, StripsShrinkInCostAndNotInTiles) {
  // The first half of the rows costs a hundred times as much a tile.
  std::vector<double> costs = RowCosts::even(400, kTileSeconds).trace;
  for (std::size_t row = 0; row < 200; ++row) costs[row] *= 100;
  StripScheduler scheduler(RowOwners(std::vector<double>(400, 1.0), 1), costs, kMinCost);
  const auto cost_of = [&](const TileRange& strip) {
    double cost = 0;
    for (std::uint64_t number = strip.first; number < strip.last; ++number) {
      const std::size_t row = TileTriangle(400).row_of(number);
      cost += costs[row] / static_cast<double>(400 - row);
    }
    return cost;
  };
  double left = sum(costs), last = 0;
  std::uint64_t longest_dear = 0, longest_cheap = 0;  // tiles of strips
  const std::uint64_t cheap = TileTriangle(400).first_of(200);
  while (const auto strip = scheduler.next(0)) {
    const double cost = cost_of(*strip);
    // A tile is not split; the last strip may be half the least cost more.
    const double wanted = std::max(kMinCost, left / 16) + 100 * kTileSeconds + kMinCost / 2;
    EXPECT_LE(cost, wanted);
    if (strip->last <= cheap) longest_dear = std::max(longest_dear, strip->size());
    if (strip->first >= cheap) longest_cheap = std::max(longest_cheap, strip->size());
    last = cost;
    left -= cost;
  }
  EXPECT_NEAR(left, 0, 1e-9);
  EXPECT_GT(longest_cheap, 20 * longest_dear) << "cheap tiles come in longer strips";
  EXPECT_LT(last, 2 * kMinCost + 100 * kTileSeconds);
}

TEST(StripScheduler, TheFirstTenthIsOfAllPartsOfTheMatrix) {
  for (const int ranks : {1, 2, 16}) {
    StripScheduler scheduler = even_scheduler(2000, ranks);
    const double all = scheduler.cost_to_assign();
    constexpr std::size_t kParts = 10;
    std::array<double, kParts> of_parts{};
    double assigned = 0;
    for (int k = 0; assigned < 0.1 * all; ++k) {
      const auto strip = scheduler.next(k % ranks);
      ASSERT_TRUE(strip);
      const double middle = 0.5 * static_cast<double>(strip->first + strip->last);
      of_parts.at(static_cast<std::size_t>(middle * kParts * kTileSeconds / all)) += scheduler.cost(*strip);
      assigned += scheduler.cost(*strip);
    }
    // Pieces are whole rows, and with 16 ranks a rank's share is in 32 of them, of which it has done three or
    // four.
    for (const double part : of_parts) EXPECT_NEAR(part / assigned, 0.1, 0.05) << ranks;
  }
}

TEST(StripScheduler, CostsOfStripsAreAllThatThereIsToAssign) {
  const std::vector<double> costs = uneven_costs(100);
  const std::vector<TileRange> done{{0, 500}, {700, 1234}};
  StripScheduler scheduler(RowOwners(costs, 3), costs, kMinCost, done);
  double assigned = 0;
  while (const auto strip = scheduler.next(1)) assigned += scheduler.cost(*strip);
  EXPECT_NEAR(assigned, scheduler.cost_to_assign(), 1e-9);
  EXPECT_NEAR(assigned, sum(costs) - scheduler.cost(done[0]) - scheduler.cost(done[1]), 1e-9);
}

TEST(StripScheduler, RowsAreSplitWhereOneIsDear) {
  // A single dear row among ranks that have nothing else.
  const std::vector<double> costs{100.0, 0, 0, 0};
  StripScheduler scheduler(RowOwners(std::vector<double>(4, 1.0), 4), costs, kMinCost);
  const auto strip = scheduler.next(0);
  ASSERT_TRUE(strip);
  EXPECT_EQ(strip->size(), 1u);
}

TEST(StripScheduler, ASlowRankDelaysNobodyForLong) {
  for (const double slowness : {1.0, 3.0, 10.0, 30.0}) {
    for (const std::size_t slow : {0u, 2u}) {  // the master too
      std::vector<ScriptedWorker> crew(4);
      crew[slow].seconds_a_tile *= slowness;
      StripScheduler scheduler = even_scheduler(400, 4);
      const double all = 400 * 401 / 2.0;
      const Played played = play(scheduler, crew);
      const double speed = 3 + 1 / slowness;  // tiles in a unit of time
      const double ideal = all / speed * kTileSeconds;
      // No strip is more than a 16th of a rank's even share; the last ones are far less.
      const double first_strip = all / 4 / 16 * kTileSeconds * slowness;
      EXPECT_LE(played.end, std::max(1.02 * ideal, first_strip) + slowness * 2 * kMinCost)
          << "slower by " << slowness;
    }
  }
}

// As one with a GPU among others: a strip that is right for it would keep the others busy long after its end.
TEST(StripScheduler, ARankFarFasterThanOthersIsWaitedForByNobody) {
  constexpr double kSpeed = 300;
  for (const std::size_t fast : {0u, 2u}) {
    std::vector<ScriptedWorker> crew(4);
    std::vector<double> min_costs(4, kMinCost);
    crew[fast].seconds_a_tile /= kSpeed;
    min_costs[fast] *= kSpeed;
    const RowCosts costs = RowCosts::even(1000, kTileSeconds);
    StripScheduler scheduler(RowOwners(costs.solve, 4), costs.trace, min_costs);
    const Played played = play(scheduler, crew);
    const double all = 1000 * 1001 / 2.0;
    EXPECT_EQ(missing_tiles(played.strips, 1000 * 1001 / 2), 0u);
    EXPECT_LE(played.end, 1.05 * all / (3 + kSpeed) * kTileSeconds + 2 * kMinCost);
  }
}

TEST(StripScheduler, ARankThatLosesItsSpeedGetsStripsLikeOthers) {
  constexpr int kRanks = 40, kFast = 2;
  const RowCosts costs = RowCosts::even(1000, kTileSeconds);
  std::vector<double> min_costs(kRanks, kMinCost);
  min_costs[kFast] *= 300;
  StripScheduler scheduler(RowOwners(costs.solve, kRanks), costs.trace, min_costs);
  const auto next_cost = [&] { return scheduler.cost(scheduler.next(kFast).value()); };
  const double share = scheduler.cost_to_assign() / 16 / kRanks;
  EXPECT_GT(next_cost(), 1.2 * share);
  scheduler.set_min_cost(kFast, kMinCost);
  EXPECT_LT(next_cost(), 1.02 * share);
}

TEST(StripScheduler, WorkersFasterThanTheMasterTakeItsRows) {
  StripScheduler scheduler = even_scheduler(200, 3);
  const Played played = play(scheduler, {{100 * kTileSeconds}, {kTileSeconds}, {kTileSeconds}});
  EXPECT_LT(played.tiles[0], 0.03 * 200 * 201 / 2);
  EXPECT_EQ(missing_tiles(played.strips, 200 * 201 / 2), 0u);
}

TEST(StripScheduler, WhatADeadRankHadIsAllThatIsMissing) {
  StripScheduler scheduler = even_scheduler(200, 4);
  std::vector<ScriptedWorker> crew(4);
  crew[3].dies_at = 1.5;
  const Played played = play(scheduler, crew);
  const std::uint64_t missing = missing_tiles(played.strips, 200 * 201 / 2);
  EXPECT_GT(missing, 0u);
  EXPECT_LE(missing, 200u * 201 / 2 / 4 / 16 + 1) << "one strip";

  // A later job with another number of ranks schedules what is missing, and nothing else.
  StripScheduler again = even_scheduler(200, 3, played.strips);
  EXPECT_EQ(again.tiles_to_assign(), missing);
  Played rest = play(again, std::vector<ScriptedWorker>(3));
  rest.strips.insert(rest.strips.end(), played.strips.begin(), played.strips.end());
  std::ranges::sort(rest.strips, {}, &TileRange::first);
  EXPECT_EQ(missing_tiles(rest.strips, 200 * 201 / 2), 0u);
}

TEST(StripScheduler, FewerStripsThanRanks) {
  StripScheduler scheduler = even_scheduler(2, 5);  // three tiles, worth one message
  const Played played = play(scheduler, std::vector<ScriptedWorker>(5));
  EXPECT_EQ(missing_tiles(played.strips, 3), 0u);
  EXPECT_LE(played.strips.size(), 3u);
}

TEST(StripScheduler, NothingToAssign) {
  StripScheduler none = even_scheduler(0, 3);
  EXPECT_FALSE(none.next(0));
  EXPECT_FALSE(none.next(2));
  EXPECT_EQ(none.tiles_to_assign(), 0u);

  const std::vector<TileRange> all{{0, 20}, {20, 55}};
  StripScheduler done = even_scheduler(10, 3, all);
  EXPECT_FALSE(done.next(1));
  EXPECT_EQ(done.tiles_to_assign(), 0u);
}

TEST(StripScheduler, RowsWithoutCostAreAssignedToo) {
  StripScheduler scheduler(RowOwners(std::vector<double>(50, 0.0), 3), std::vector<double>(50, 0.0),
                           kMinCost);
  EXPECT_EQ(missing_tiles(play(scheduler, std::vector<ScriptedWorker>(3)).strips, 50 * 51 / 2), 0u);
}

}  // namespace
}  // namespace fluxel::test
