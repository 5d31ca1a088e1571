#include "mpi_master/strip_scheduler.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace fluxel::test {
namespace {

constexpr std::size_t kSizes[] = {0, 1, 2, 3, 5, 7, 31, 32, 33, 64, 100, 257, 1000};

TEST(OwnedRows, PartsFollowOneAnotherAndAreEven) {
  for (const std::size_t rows : kSizes) {
    for (int ranks = 1; ranks <= 16; ++ranks) {
      std::size_t end = 0;
      for (int rank = 0; rank < ranks; ++rank) {
        const TileRows part = owned_rows(rows, ranks, rank);
        EXPECT_EQ(part.first, end);
        EXPECT_GE(part.size(), rows / static_cast<std::size_t>(ranks));
        EXPECT_LE(part.size(), rows / static_cast<std::size_t>(ranks) + 1);
        end = part.last;
      }
      EXPECT_EQ(end, rows) << ranks << " ranks";
    }
  }
}

TEST(OwnedRows, OwnerOfIsTheInverse) {
  for (const std::size_t rows : kSizes)
    for (int ranks = 1; ranks <= 16; ++ranks)
      for (int rank = 0; rank < ranks; ++rank)
        for (std::size_t row = owned_rows(rows, ranks, rank).first; row < owned_rows(rows, ranks, rank).last;
             ++row)
          ASSERT_EQ(owner_of(rows, ranks, row), rank) << row << " of " << rows << ", " << ranks << " ranks";
}

/// Workers that need this many units of time for a tile; the one that is free first asks first, as in a job.
struct Deal {
  std::vector<int> times_dealt;  ///< of each row
  std::vector<double> tiles;     ///< of each rank
  std::vector<double> finished;  ///< when each rank had nothing left to do
  bool complete = false;
};

Deal play(std::size_t rows, const std::vector<double>& cost) {
  StripScheduler scheduler(rows, static_cast<int>(cost.size()));
  Deal deal{std::vector<int>(rows), std::vector<double>(cost.size()), std::vector<double>(cost.size()),
            false};
  std::vector<bool> dismissed(cost.size());
  std::size_t taken_rows = 0;
  while (std::ranges::count(dismissed, false) > 0) {
    std::size_t rank = 0;
    while (dismissed[rank]) ++rank;
    for (std::size_t other = rank; other < cost.size(); ++other)
      if (!dismissed[other] && deal.finished[other] < deal.finished[rank]) rank = other;
    const auto strip = scheduler.next(static_cast<int>(rank));
    if (!strip) {
      EXPECT_EQ(taken_rows, rows) << "dismissed while there is work";
      dismissed[rank] = true;
      continue;
    }
    EXPECT_GT(strip->size(), 0u) << "an empty strip means that there is no more";
    for (std::size_t row = strip->first; row < strip->last; ++row) {
      ++deal.times_dealt.at(row);
      deal.tiles[rank] += static_cast<double>(rows - row);
      deal.finished[rank] += cost[rank] * static_cast<double>(rows - row);
    }
    taken_rows += strip->size();
  }
  deal.complete = scheduler.tiles_dealt() == scheduler.tiles_in_all() &&
                  scheduler.tiles_in_all() == rows * (rows + 1) / 2;
  return deal;
}

TEST(StripScheduler, EveryRowIsDealtExactlyOnce) {
  const std::vector<std::vector<double>> costs{{1},
                                               {1, 1},
                                               {1, 20},
                                               {20, 1},
                                               {1, 2, 3, 4},
                                               {50, 1, 1},
                                               {1, 1, 1, 1, 1, 1, 1},
                                               std::vector<double>(40, 1.0)};
  for (const std::size_t rows : kSizes) {
    for (const auto& cost : costs) {
      const Deal deal = play(rows, cost);
      EXPECT_TRUE(std::ranges::all_of(deal.times_dealt, [](int times) { return times == 1; }))
          << rows << " rows, " << cost.size() << " ranks";
      EXPECT_TRUE(deal.complete);
    }
  }
}

TEST(StripScheduler, ARankBeginsWithItsOwnRows) {
  StripScheduler scheduler(90, 3);
  for (const int rank : {2, 0, 1}) {
    const TileRows own = owned_rows(90, 3, rank);
    const auto strip = scheduler.next(rank);
    ASSERT_TRUE(strip);
    EXPECT_EQ(strip->first, own.first) << "its largest strip is the one on top";
    EXPECT_TRUE(own.contains(strip->last - 1));
  }
}

TEST(StripScheduler, FastRanksTakeOverFromSlowOnes) {
  // Rank 0 is ten times slower. With no waste rank 1 would do 10/11 of the tiles; at worst it waits at the
  // end for the last strip of rank 0, which is never more than the largest (a 32nd of its own rows).
  const std::size_t rows = 640;
  const Deal deal = play(rows, {10, 1});
  const double all = rows * (rows + 1) / 2.0, largest_strip = 10.0 * rows;
  EXPECT_LE(*std::ranges::max_element(deal.finished), all * 10 / 11 + 10 * largest_strip);
  EXPECT_GT(deal.tiles[1], 0.8 * all);
}

TEST(StripScheduler, StripsShrinkTowardsTheEnd) {
  StripScheduler scheduler(6400, 2);
  std::size_t last = 6400;
  while (const auto strip = scheduler.next(1)) {
    if (strip->first == owned_rows(6400, 2, 0).first) break;  // of the other's rows
    EXPECT_LE(strip->size(), last);
    last = strip->size();
  }
  EXPECT_EQ(last, 1u) << "or dear rows at the end keep one rank busy while the others wait";
}

TEST(StripScheduler, NothingToDealWithoutRows) {
  StripScheduler scheduler(0, 3);
  EXPECT_FALSE(scheduler.next(0));
  EXPECT_FALSE(scheduler.next(2));
  EXPECT_EQ(scheduler.tiles_in_all(), 0u);
}

TEST(StripScheduler, RanksWithoutRowsOfTheirOwnHelp) {
  StripScheduler scheduler(2, 5);
  std::size_t dealt = 0;
  for (const int rank : {0, 1})  // own none of two rows among five ranks
    if (owned_rows(2, 5, rank).size() == 0)
      if (const auto strip = scheduler.next(rank)) dealt += strip->size();
  EXPECT_EQ(dealt, 2u);
}

}  // namespace
}  // namespace fluxel::test
