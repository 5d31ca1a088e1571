#include "mpi_master/scheduling/scheduled_tiles.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <thread>

#include "mpi_master/scheduling/row_owners.hpp"
#include "world.hpp"

namespace fluxel::test {
namespace {

constexpr std::size_t kSide = 60;
constexpr int kTile = TileWork::kFirstTag;

/// Every tile's number goes to the rank that follows; one rank wishes to stop after some of its own.
class CountingWork final : public TileWork {
 public:
  explicit CountingWork(std::uint64_t stop_after) : stop_after_(stop_after) {}

  void begin(const TileRange&) override {}
  std::uint64_t compute(const TileRange& batch) override {
    batch_ = batch;
    computed += batch.size();
    std::this_thread::sleep_for(std::chrono::microseconds(200) * batch.size());
    return batch.size();
  }
  void deliver() override {
    for (std::uint64_t number = batch_.first; number < batch_.last; ++number) {
      const auto bytes = std::as_bytes(std::span(&number, 1));
      world().send((world().rank() + 1) % world().size(), kTile, Bytes(bytes.begin(), bytes.end()));
    }
  }
  void take(const Message& message) override {
    EXPECT_EQ(message.tag, kTile);
    ++taken;
  }
  [[nodiscard]] bool complete() const override { return true; }
  bool between_batches() override { return computed >= stop_after_; }

  std::uint64_t computed = 0, taken = 0;

 private:
  std::uint64_t stop_after_;
  TileRange batch_;
};

std::uint64_t sum_of(std::uint64_t value) {
  world().all_sum(std::span(&value, 1));
  return value;
}

/// Schedules all tiles on all ranks; `stopper` stops after so many of its own.
void check(int stopper, std::uint64_t stop_after, bool stops) {
  const std::vector<double> costs(kSide, 1e-3);
  const RowOwners owners(costs, world().size());
  StripScheduler scheduler(owners, costs, 1e-3);
  CountingWork work(world().rank() == stopper ? stop_after : ~std::uint64_t{0});
  SilentProgress progress;
  const ScheduleRecord schedule = schedule_tiles({world(), 1, progress}, scheduler, work);
  EXPECT_EQ(schedule.stopped, stops);
  EXPECT_EQ(sum_of(work.taken), sum_of(work.computed)) << "whatever was sent has arrived";
  const std::uint64_t all = TileTriangle(kSide).size();
  if (stops) {
    EXPECT_LT(sum_of(work.computed), all);
  } else {
    EXPECT_EQ(sum_of(work.computed), all);
  }
  EXPECT_FALSE(world().receive()) << "a message is left over";
  world().barrier();  // before anybody sends what comes next
}

TEST(ScheduledTiles, AllAreComputedWhereNobodyStops) { check(0, ~std::uint64_t{0}, false); }

TEST(ScheduledTiles, AnyRankStopsAllAndNothingIsLost) {
  for (int stopper = 0; stopper < world().size(); ++stopper) check(stopper, 20, true);
}

TEST(ScheduledTiles, AStopBeforeTheFirstStripIsNoError) { check(world().size() - 1, 0, true); }

TEST(Communicator, ReceiveAllWaitsForEveryMessageUnderWay) {
  const auto size = static_cast<std::size_t>(world().size());
  for (std::size_t repeat = 0; repeat < 5; ++repeat) {
    // Large ones too, which leave only when they are received; some ranks come late.
    if (world().rank() % 2 == 1) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    std::size_t bytes = 0, messages = 0;
    for (std::size_t target = 0; target < size; ++target)
      for (std::size_t k = 0; k < target + repeat; ++k)
        world().send(static_cast<int>(target), kTile, Bytes(k % 2 == 0 ? 1 : 200'000));
    world().receive_all([&](const Message& message) {
      bytes += message.data.size();
      ++messages;
    });
    const std::size_t each = own_rank() + repeat;
    EXPECT_EQ(messages, size * each);
    EXPECT_EQ(bytes, size * ((each + 1) / 2 + each / 2 * 200'000));
    EXPECT_EQ(world().pending_sends(), 0u);
  }
}

}  // namespace
}  // namespace fluxel::test
