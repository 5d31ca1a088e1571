#include "mpi_master/communication/communicator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

#include "world.hpp"

namespace fluxel::test {
namespace {

Bytes pattern(std::size_t size, std::size_t seed) {
  Bytes bytes(size);
  for (std::size_t k = 0; k < size; ++k)
    bytes[k] = static_cast<std::byte>((k * 131 + seed * 17 + k / 251) & 255);
  return bytes;
}

TEST(Communicator, RanksAreNumberedFromZero) {
  EXPECT_LT(world().rank(), world().size());
  const std::size_t mine = own_rank();
  const std::vector<std::size_t> all = world().all_gather(std::span(&mine, 1));
  std::vector<std::size_t> expected(ranks());
  std::iota(expected.begin(), expected.end(), std::size_t{0});
  EXPECT_EQ(all, expected);
}

TEST(Communicator, BroadcastOfNothingEmptiesWhatTheOthersHold) {
  Bytes bytes = world().is_root() ? Bytes{} : pattern(10, 1);
  world().broadcast(bytes);
  EXPECT_TRUE(bytes.empty());
}

TEST(Communicator, BroadcastOfTenMegabytesFromEveryRank) {
  for (int root = 0; root < world().size(); ++root) {
    const Bytes expected = pattern(10'000'001, static_cast<std::size_t>(root));
    Bytes bytes = world().rank() == root ? expected : Bytes(3);
    world().broadcast(bytes, root);
    EXPECT_TRUE(bytes == expected) << "from rank " << root;
  }
}

TEST(Communicator, GatheringKeepsTheOrderOfRanksOfWhichSomeHaveNothing) {
  // Rank r brings r items, so that rank 0 always has none; then only the last one brings some.
  std::vector<std::uint32_t> expected;
  for (std::size_t rank = 0; rank < ranks(); ++rank)
    for (std::size_t k = 0; k < rank; ++k) expected.push_back(static_cast<std::uint32_t>(1000 * rank + k));
  std::vector<std::uint32_t> mine(own_rank());
  std::iota(mine.begin(), mine.end(), static_cast<std::uint32_t>(1000 * own_rank()));
  EXPECT_EQ(world().all_gather(std::span<const std::uint32_t>(mine)), expected);

  const std::vector<double> last(own_rank() + 1 == ranks() ? 5 : 0, 0.25);
  EXPECT_EQ(world().all_gather(std::span<const double>(last)), std::vector<double>(5, 0.25));
  EXPECT_TRUE(world().all_gather(std::span<const double>()).empty());
}

TEST(Communicator, GatheringOfItemsOfOddSize) {
  struct Item {
    std::array<std::uint8_t, 13> value;
    bool operator==(const Item&) const = default;
  };
  static_assert(sizeof(Item) == 13);
  const auto item = [](std::size_t rank, std::size_t k) {
    Item made{};
    for (std::size_t b = 0; b < made.value.size(); ++b)
      made.value[b] = static_cast<std::uint8_t>(rank * 40 + k * 7 + b);
    return made;
  };
  const auto count = [](std::size_t rank) { return 2 * rank + 1; };
  std::vector<Item> mine, expected;
  for (std::size_t k = 0; k < count(own_rank()); ++k) mine.push_back(item(own_rank(), k));
  for (std::size_t rank = 0; rank < ranks(); ++rank)
    for (std::size_t k = 0; k < count(rank); ++k) expected.push_back(item(rank, k));
  EXPECT_TRUE(world().all_gather(std::span<const Item>(mine)) == expected);
}

TEST(Communicator, ReductionsAreElementWise) {
  const auto rank = static_cast<double>(own_rank());
  const auto last = static_cast<double>(ranks() - 1);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();

  std::vector<double> least{rank, -rank, own_rank() == 0 ? 3.5 : kInfinity, kInfinity};
  world().all_min(least);
  EXPECT_EQ(least, (std::vector<double>{0, -last, 3.5, kInfinity}));

  std::vector<double> most{rank, -rank, own_rank() == 0 ? 3.5 : -kInfinity};
  world().all_max(most);
  EXPECT_EQ(most, (std::vector<double>{last, 0, 3.5}));

  // Beyond 2^53, where a detour over double would show.
  const std::uint64_t large = (std::uint64_t{1} << 60) + 1;
  std::vector<std::uint64_t> least_whole{large + own_rank(), ~std::uint64_t{0}};
  world().all_min(least_whole);
  EXPECT_EQ(least_whole, (std::vector<std::uint64_t>{large, ~std::uint64_t{0}}));

  std::vector<std::uint32_t> least_short{0xFFFFFFFFu, static_cast<std::uint32_t>(7 + own_rank())};
  world().all_min(least_short);
  EXPECT_EQ(least_short, (std::vector<std::uint32_t>{0xFFFFFFFFu, 7}));

  std::vector<std::uint64_t> sum{own_rank(), large / 8};
  world().all_sum(sum);
  EXPECT_EQ(sum, (std::vector<std::uint64_t>{ranks() * (ranks() - 1) / 2, ranks() * (large / 8)}));
}

TEST(Communicator, ManyMessagesArriveWholeAndInOrder) {
  constexpr std::size_t kMessages = 300;
  // Empty ones, small ones, and some beyond what MPI sends without asking the receiver first.
  const auto size = [](std::size_t k) { return k % 100 == 99 ? std::size_t{1'000'000} : (k * 37) % 500; };
  for (std::size_t k = 0; k < kMessages; ++k)
    for (int target = 0; target < world().size(); ++target)
      if (target != world().rank())
        world().send(target, static_cast<int>(k % 3), pattern(size(k), own_rank() + k));

  std::map<std::pair<int, int>, std::size_t> next;  // for each source and tag, the message that must come
  std::size_t arrived = 0, wrong = 0;
  while (arrived < kMessages * (ranks() - 1)) {
    const auto message = world().receive();
    if (!message) continue;
    const auto expected = next.try_emplace({message->source, message->tag}, message->tag).first;
    if (message->data !=
        pattern(size(expected->second), static_cast<std::size_t>(message->source) + expected->second))
      ++wrong;
    expected->second += 3;
    ++arrived;
  }
  EXPECT_EQ(wrong, 0u);
  while (world().pending_sends() > 0) continue;
  world().barrier();
  EXPECT_FALSE(world().receive().has_value());
  world().barrier();  // before anybody sends what the next test is about
}

}  // namespace
}  // namespace fluxel::test
