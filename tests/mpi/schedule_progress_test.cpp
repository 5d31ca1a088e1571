#include "mpi_master/scheduling/schedule_progress.hpp"

#include <gtest/gtest.h>

namespace fluxel::test {
namespace {

TEST(ScheduleProgress, OfALastStripThePaceTells) {
  ScheduleProgress progress(3);
  EXPECT_EQ(progress.done_by_others(1), 0);
  progress.assign(1, 10, 0);
  // Nothing is known of the rank's pace yet.
  EXPECT_EQ(progress.done_by_others(3), 0);
  // 10 in 5 s: the next 6 take 3 s.
  progress.assign(1, 6, 5);
  EXPECT_NEAR(progress.done_by_others(5), 10, 1e-12);
  EXPECT_NEAR(progress.done_by_others(6), 12, 1e-12);
  EXPECT_NEAR(progress.done_by_others(100), 16, 1e-12) << "no more than it has";
  progress.assign(1, 0, 9);
  EXPECT_NEAR(progress.done_by_others(10), 16, 1e-12);
}

TEST(ScheduleProgress, RanksAddUpAndRankZeroIsNoneOfThem) {
  ScheduleProgress progress(3);
  for (const int rank : {0, 1, 2}) progress.assign(rank, 10, 0);
  for (const int rank : {0, 1, 2}) progress.assign(rank, 10, 2);
  EXPECT_NEAR(progress.done_by_others(3), 30, 1e-12);
}

}  // namespace
}  // namespace fluxel::test
