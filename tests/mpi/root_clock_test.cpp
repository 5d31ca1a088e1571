#include "mpi_master/communication/root_clock.hpp"

#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "world.hpp"

namespace fluxel::test {
namespace {

TEST(RootClock, TheRootsTimeCountsOnAllRanks) {
  using namespace std::chrono_literals;
  // Each rank has started at another time.
  const RootClock clock(world(), RootClock::Clock::now() - (100s + 50s * world().rank()));
  const double seconds = clock.seconds();
  EXPECT_GE(seconds, 100);
  EXPECT_LT(seconds, 150) << "the time of another rank";
  const std::vector<double> of_all = world().all_gather(std::span<const double>(&seconds, 1));
  for (const double of_rank : of_all) EXPECT_EQ(of_rank, seconds);
  EXPECT_GE(clock.own_seconds(), 100 + 50 * world().rank());
}

}  // namespace
}  // namespace fluxel::test
