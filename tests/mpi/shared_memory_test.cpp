#include "mpi_master/communication/shared_memory.hpp"

#include <gtest/gtest.h>

#include <cctype>
#include <fstream>
#include <numeric>
#include <string>

#include "host_shapes.hpp"
#include "mpi_master/communication/host_gather.hpp"
#include "mpi_master/communication/machine.hpp"

namespace fluxel::test {
namespace {

TEST(OrderByHosts, RanksOfAHostFollowOneAnother) {
  for (const HostShape& shape : host_shapes()) {
    SCOPED_TRACE(shape.name);
    const Communicator& ordered = shape.world;
    EXPECT_EQ(ordered.size(), world().size());
    EXPECT_EQ(ordered.is_root(), world().is_root()) << "the root stays";
    std::size_t ranks_in_all = 0;
    for (const ItemRange& ranks : ordered.hosts()) {
      EXPECT_EQ(ranks.first, ranks_in_all);
      ranks_in_all += ranks.count;
    }
    EXPECT_EQ(ranks_in_all, ranks());
    // A rank's place on its host and the host's place among all give its number.
    const auto place = static_cast<std::size_t>(ordered.host().rank());
    std::uint64_t host = ordered.is_leader() ? static_cast<std::uint64_t>(ordered.leaders().rank()) : 0;
    ordered.host().all_sum(std::span(&host, 1));
    const ItemRange& own = ordered.hosts()[host];
    EXPECT_EQ(static_cast<std::size_t>(ordered.rank()), own.first + place);
    EXPECT_EQ(static_cast<std::size_t>(ordered.host().size()), own.count);
    if (ordered.is_leader()) {
      EXPECT_EQ(static_cast<std::size_t>(ordered.leaders().size()), ordered.hosts().size());
    }
  }
}

TEST(OrderByHosts, HostsFollowTheirLowestRanks) {
  const auto rank = static_cast<int>(own_rank());
  // Numbers descend, ranks are assigned round-robin.
  const Communicator ordered = world().ordered_by_hosts(100 - rank % 2);
  const std::vector<int> old_ranks = ordered.all_gather(std::span(&rank, 1));
  std::vector<int> expected;
  for (const int first : {0, 1})
    for (int old = first; old < world().size(); old += 2) expected.push_back(old);
  EXPECT_EQ(old_ranks, expected);
}

TEST(SharedArray, EveryRankSeesWhatTheOthersOfItsHostWrite) {
  constexpr std::size_t kEach = 1000;
  for (const HostShape& shape : host_shapes()) {
    SCOPED_TRACE(shape.name);
    const Communicator& host = shape.world.host();
    const auto size = static_cast<std::size_t>(host.size());
    SharedArray<double> array(host, size * kEach);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(array.items().data()) % 64, 0u);
    for (int round = 0; round < 3; ++round) {
      const double value = 10 * shape.world.rank() + round;
      std::ranges::fill(array.items().subspan(static_cast<std::size_t>(host.rank()) * kEach, kEach), value);
      array.publish();
      const double first = shape.world.rank() - host.rank();
      for (std::size_t k = 0; k < array.size(); ++k) {
        const std::size_t writer = k / kEach;
        ASSERT_EQ(array.items()[k], 10 * (first + static_cast<double>(writer)) + round);
      }
      array.publish();
    }
  }
}

/// This process's part of the mapping in which `items` lie, in bytes. Its other memory comes and goes as
/// allocators and libraries please.
std::uint64_t mapped_bytes(std::span<const std::uint8_t> items) {
  const auto first = reinterpret_cast<std::uintptr_t>(items.data());
  std::ifstream smaps("/proc/self/smaps");
  std::uint64_t kilobytes = 0;
  bool holds_items = false;
  for (std::string line; std::getline(smaps, line);) {
    if (std::isupper(static_cast<unsigned char>(line.front())) == 0) {
      std::size_t digits = 0;
      const std::uint64_t begin = std::stoull(line, &digits, 16);
      const std::uint64_t end = std::stoull(line.substr(digits + 1), nullptr, 16);
      holds_items = begin < first + items.size() && first < end;
    } else if (holds_items && line.starts_with("Pss:")) {
      kilobytes += std::stoull(line.substr(4));
    }
  }
  return 1024 * kilobytes;
}

TEST(SharedArray, IsHeldOnceAHost) {
  constexpr std::size_t kBytes = std::size_t{64} << 20;  // more than the heap keeps for itself
  for (const HostShape& shape : host_shapes()) {
    SCOPED_TRACE(shape.name);
    SharedArray<std::uint8_t> array(shape.world.host(), kBytes);
    const auto held_by_all = [&array] {
      world().barrier();
      std::uint64_t bytes = mapped_bytes(array.items());
      EXPECT_GE(proportional_bytes(), bytes);
      world().all_sum(std::span(&bytes, 1));
      return static_cast<double>(bytes);
    };
    const double before = held_by_all();
    if (shape.world.is_leader()) std::ranges::fill(array.items(), std::uint8_t{1});
    array.publish();
    std::uint64_t sum = 0;
    for (const std::uint8_t byte : array.items()) sum += byte;
    EXPECT_EQ(sum, kBytes);
    const auto hosts = static_cast<double>(shape.world.hosts().size());
    EXPECT_NEAR((held_by_all() - before) / kBytes, hosts, 0.1 * hosts);
    world().barrier();
  }
}

TEST(SharedArray, NothingIsNoMemory) {
  const SharedArray<int> none(world().host(), 0);
  EXPECT_TRUE(none.items().empty());
  none.publish();
}

TEST(SharedArray, CanBeMovedAndMadeAnew) {
  SharedArray<int> array(world().host(), 10);
  if (world().is_leader()) array.items()[7] = 42;
  SharedArray<int> moved = std::move(array);
  moved.publish();
  EXPECT_EQ(moved.items()[7], 42);
  moved = SharedArray<int>(world().host(), 3);
  EXPECT_EQ(moved.size(), 3u);
}

TEST(GatherOnHosts, EveryHostHasAllItemsInTheOrderOfTheRanks) {
  for (const HostShape& shape : host_shapes()) {
    SCOPED_TRACE(shape.name);
    // Of some ranks nothing.
    const auto count = [](int rank) { return static_cast<std::size_t>(rank % 3) * 500; };
    std::vector<int> mine(count(shape.world.rank())), expected;
    std::iota(mine.begin(), mine.end(), 10'000 * shape.world.rank());
    for (int rank = 0; rank < shape.world.size(); ++rank)
      for (std::size_t k = 0; k < count(rank); ++k) expected.push_back(10'000 * rank + static_cast<int>(k));
    const SharedArray<int> all = gather_on_hosts(shape.world, std::span<const int>(mine));
    EXPECT_TRUE(std::ranges::equal(all.items(), expected));
  }
}

TEST(GatherOnHosts, RunsAreKeptApart) {
  for (const HostShape& shape : host_shapes()) {
    SCOPED_TRACE(shape.name);
    const int rank = shape.world.rank();
    const std::vector<int> mine{rank, rank, 1000 + rank, 1000 + rank};
    const SharedArray<int> all = gather_on_hosts(shape.world, std::span<const int>(mine), 2);
    ASSERT_EQ(all.size(), 4 * ranks());
    for (std::size_t k = 0; k < all.size(); ++k) {
      const std::size_t run = k / (2 * ranks());
      EXPECT_EQ(static_cast<std::size_t>(all.items()[k]), 1000 * run + (k % (2 * ranks())) / 2);
    }
  }
}

}  // namespace
}  // namespace fluxel::test
