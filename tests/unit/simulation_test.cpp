#include <gtest/gtest.h>

#include <algorithm>

#include "bench/simulate/engine.hpp"
#include "bench/simulate/tile_map.hpp"

namespace fluxel::test {
namespace {

using namespace fluxel::bench;

constexpr double kFirstPause = 20e-6;  // of a rank that has nothing to do

/// Strips of `strip_tiles` tiles one after another, to whoever asks; a tile goes to rank `target`.
class EvenWork final : public SimulatedWork {
 public:
  EvenWork(std::uint64_t tiles, std::uint64_t strip_tiles, double tile_seconds, int target = 0)
      : tiles_(tiles), strip_tiles_(strip_tiles), tile_seconds_(tile_seconds), target_(target) {}

  std::optional<TileRange> next(int rank) override {
    if (next_ == tiles_) return std::nullopt;
    const TileRange strip{next_, std::min(tiles_, next_ + strip_tiles_)};
    next_ = strip.last;
    asked.push_back(rank);
    return strip;
  }
  Batch compute(const TileRange& tiles) override {
    const auto count = static_cast<double>(tiles.size());
    computed += tiles.size();
    return {count * tile_seconds_, {{target_, count, 100 * count}}};
  }

  std::vector<int> asked;  // ranks in the order in which they were given strips
  std::uint64_t computed = 0;

 private:
  std::uint64_t tiles_, strip_tiles_;
  double tile_seconds_;
  int target_;
  std::uint64_t next_ = 0;
};

/// Every rank on a host of its own; what is not named costs nothing.
JobSettings settings_of(std::vector<double> speed, double latency, const MessageCosts& costs = {}) {
  return {{"test", {latency, 1e12}, {}, 0, 1}, costs, true, 0, std::move(speed)};
}

TEST(Simulation, OneRankTakesItsWorkAndAPauseForEachStrip) {
  EvenWork work(320, 80, 1e-3);
  const JobResult job = simulate_job(work, settings_of({1}, 1e-3));
  EXPECT_NEAR(job.seconds, 0.320 + 4 * kFirstPause, 1e-9);
  EXPECT_NEAR(job.ranks[0].busy, 0.320, 1e-9);
  EXPECT_EQ(job.ranks[0].strips, 4u);
  EXPECT_EQ(job.ranks[0].tiles, 320u);
  EXPECT_EQ(job.ranks[0].messages_sent, 0u);
}

TEST(Simulation, RanksThatNeverSleepLoseNothingBetweenStrips) {
  EvenWork work(320, 80, 1e-3);
  JobSettings settings = settings_of({1}, 1e-3);
  settings.sleeps = false;
  EXPECT_NEAR(simulate_job(work, settings).seconds, 0.320, 1e-12);
}

TEST(Simulation, AQuarterOfTheSpeedTakesFourTimesAsLong) {
  EvenWork work(320, 320, 1e-3);
  const JobResult job = simulate_job(work, settings_of({0.25}, 0));
  EXPECT_NEAR(job.seconds, 4 * 0.320 + kFirstPause, 1e-9);
}

// One strip of one tile of 10 ms, in one batch. Rank 0 takes it at 0 and begins after a first pause; rank 1's
// question comes at 5 ms and is seen when the tile is done, so its answer is there 5 ms later: at 15 ms + one
// pause. Rank 1 sleeps from 0 on, and looks at most half a millisecond after what it waits for.
TEST(Simulation, AnAnswerWaitsForTheBatchOfRankZero) {
  EvenWork work(1, 1, 10e-3);
  const JobResult job = simulate_job(work, settings_of({1, 1}, 5e-3));
  EXPECT_NEAR(job.ranks[0].end, 10e-3 + kFirstPause, 1e-9);
  EXPECT_GE(job.ranks[1].end, 15e-3 + kFirstPause);
  EXPECT_LE(job.ranks[1].end, 15e-3 + kFirstPause + 0.5e-3);
  EXPECT_EQ(work.asked, std::vector<int>{0});
  // All have met one message up and one down a tree of two ranks later.
  EXPECT_NEAR(job.seconds, job.ranks[1].end + 2 * 5e-3, 1e-9);
}

// A strip of one tile of 1 s: rank 1's question comes while rank 0 is at the first one, so that it waits for
// that second, computes the other, and its own tile travels to rank 0.
TEST(Simulation, TilesTravelToTheirOwner) {
  EvenWork work(2, 1, 1.0, 0);
  MessageCosts costs;
  costs.send = 1e-3, costs.receive = 2e-3, costs.tile_out = 3e-3, costs.tile_in = 4e-3;
  const JobResult job = simulate_job(work, settings_of({1, 1}, 0, costs));
  EXPECT_EQ(job.ranks[0].tiles, 1u);
  EXPECT_EQ(job.ranks[1].tiles, 1u);
  // Rank 0: its own tile into the store, two questions and two answers, then rank 1's tile.
  EXPECT_NEAR(job.ranks[0].messages, 4e-3 + 2 * (2e-3 + 1e-3) + (2e-3 + 4e-3), 1e-9);
  // Rank 1: two questions and two answers, then a tile out.
  EXPECT_NEAR(job.ranks[1].messages, 2 * (1e-3 + 2e-3) + (3e-3 + 1e-3), 1e-9);
  EXPECT_DOUBLE_EQ(job.ranks[1].bytes_sent, 100);  // of two questions none
  EXPECT_EQ(job.ranks[1].messages_sent, 3u);
  for (const RankTimes& rank : job.ranks)
    EXPECT_NEAR(rank.busy + rank.messages + rank.waiting, job.seconds, 1e-9);
}

// 40 strips of 100 ms. A question, the batch that rank 0 is at and the answer take up to 4 ms, the last four
// batches of a strip 8 ms: rank 1 waits for its first strip and for the word that there is no more, not for
// each.
TEST(Simulation, AStripIsAskedForAheadSoThatItIsThereInTime) {
  EvenWork work(40'000, 1'000, 1e-4, 1);
  const JobResult job = simulate_job(work, settings_of({1, 1}, 1e-3));
  EXPECT_EQ(work.computed, 40'000u);
  EXPECT_EQ(job.total().strips, 40u);
  const RankTimes& other = job.ranks[1];
  EXPECT_LT(other.end - other.busy - other.messages, 12e-3);
}

TEST(Simulation, ASlowRankTakesFewerStrips) {
  EvenWork work(40'000, 100, 1e-4, 1);
  const JobResult job = simulate_job(work, settings_of({1, 1, 0.1}, 1e-6));
  EXPECT_NEAR(static_cast<double>(job.ranks[2].tiles) / 40'000, 0.1 / 2.1, 0.01);
  EXPECT_LT(job.seconds, 4.0 / 2.1 + 0.2);
}

TEST(Traffic, MessagesOfOneHostLeaveOneAfterAnother) {
  Traffic traffic({"test", {1e-3, 1e6}, {1e-6, 1e9}, 0, 2}, 6);
  EXPECT_TRUE(traffic.same_host(0, 1));
  EXPECT_FALSE(traffic.same_host(1, 2));
  EXPECT_DOUBLE_EQ(traffic.arrival_within_host(1000, 0), 1e-6 + 1e-6);
  // 1000 bytes take 1 ms; ranks 0 and 1 share a host, as do 2 and 3.
  EXPECT_DOUBLE_EQ(traffic.reach(0, 1000, 0), 2e-3);
  EXPECT_DOUBLE_EQ(traffic.reach(1, 1000, 0), 3e-3);
  EXPECT_DOUBLE_EQ(traffic.reach(2, 1000, 0), 2e-3);
}

TEST(Traffic, MessagesToOneHostComeOneAfterAnother) {
  Traffic traffic({"test", {1e-3, 1e6}, {}, 0, 2}, 6);
  EXPECT_DOUBLE_EQ(traffic.arrival(4, 1000, 2e-3), 2e-3);
  EXPECT_DOUBLE_EQ(traffic.arrival(5, 1000, 2e-3), 3e-3);
  EXPECT_DOUBLE_EQ(traffic.arrival(0, 1000, 2.5e-3), 2.5e-3);  // another host
  EXPECT_DOUBLE_EQ(traffic.arrival(4, 1000, 9e-3), 9e-3);
}

TEST(Traffic, SmallMessagesLeaveAtTheRateOfTheLink) {
  Traffic traffic({"test", {0, 1e9}, {}, 1e-3, 1}, 3);
  EXPECT_DOUBLE_EQ(traffic.reach(0, 1, 0), 1e-3);
  EXPECT_DOUBLE_EQ(traffic.reach(0, 1, 0), 2e-3);
}

TEST(TileMap, SumsAreThoseOfItsBlocks) {
  TileMap map(10, 3);  // blocks of 3, 3 and 4 tiles
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = row; column < 3; ++column) {
      TileBlock& block = map.at(row, column);
      block.seconds = static_cast<double>(1 + 10 * row + column);
      block.deviation = 2;
      block.bytes = 100 * block.seconds;
      block.mixed = 0.25, block.visible = 0.5;
    }
  map.finish();
  for (std::size_t row = 0; row < 10; ++row) {
    for (std::size_t first = row; first < 10; ++first) {
      for (std::size_t last = first; last <= 10; ++last) {
        double seconds = 0;
        for (std::size_t column = first; column < last; ++column)
          seconds += map.at(row < 3 ? 0 : row < 6 ? 1 : 2, column < 3 ? 0 : column < 6 ? 1 : 2).seconds;
        const TileSums sums = map.sums(row, first, last);
        const auto tiles = static_cast<double>(last - first);
        ASSERT_NEAR(sums.seconds, seconds, 1e-9) << row << " " << first << " " << last;
        ASSERT_NEAR(sums.bytes, 100 * seconds, 1e-9);
        ASSERT_NEAR(sums.variance, 4 * tiles, 1e-9);
        ASSERT_NEAR(sums.lit, 0.75 * tiles, 1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace fluxel::test
