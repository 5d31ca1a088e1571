#include "core/ranks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "tests/unit/virtual_ranks.hpp"

namespace fluxel {
namespace {

using test_scenes::VirtualRanks;

/// Items of a rank, which no other has: many of the first, and fewer of each that follows.
std::vector<std::uint32_t> items_of(std::size_t rank, std::size_t most) {
  std::vector<std::uint32_t> items(most / (rank + 1));
  std::iota(items.begin(), items.end(), static_cast<std::uint32_t>(rank) << 24);
  return items;
}

TEST(Ranks, DistributedItemsAreAllThereOnceAndEvenlyShared) {
  for (const std::size_t count : {1U, 2U, 3U, 5U}) {
    for (const std::size_t most : {0U, 1U, 100U, 200'000U}) {
      std::vector<std::vector<std::uint32_t>> distributed(count);
      VirtualRanks::run(count, [&](const Ranks& ranks) {
        distributed[ranks.rank] = distribute(ranks, items_of(ranks.rank, most));
      });
      std::vector<std::uint32_t> all, expected;
      for (std::size_t rank = 0; rank < count; ++rank) {
        const std::vector<std::uint32_t> items = items_of(rank, most);
        expected.insert(expected.end(), items.begin(), items.end());
        all.insert(all.end(), distributed[rank].begin(), distributed[rank].end());
      }
      for (const auto& share : distributed) EXPECT_LE(share.size(), expected.size() / count + 1);
      std::ranges::sort(all);
      EXPECT_EQ(all, expected) << count << " ranks, " << most;
    }
  }
}

TEST(Ranks, NoRankGathersAllThatPassesThroughIt) {
  constexpr std::size_t kMax = 300'000;
  for (const std::size_t count : {2U, 3U}) {
    std::vector<std::vector<std::uint32_t>> taken(count);
    std::vector<std::size_t> largest(count);
    VirtualRanks::run(count, [&](const Ranks& ranks) {
      Ranks watched = ranks;
      watched.gather_bytes = [&](std::span<const std::byte> mine) {
        std::vector<std::byte> all = ranks.gather_bytes(mine);
        largest[ranks.rank] = std::max(largest[ranks.rank], all.size() / sizeof(std::uint32_t));
        return all;
      };
      const std::vector<std::uint32_t> mine = items_of(ranks.rank, kMax);
      gather_in_parts(watched, std::span(mine),
                      [&](std::uint32_t item) { taken[ranks.rank].push_back(item); });
    });
    for (std::size_t rank = 0; rank < count; ++rank) {
      EXPECT_LE(largest[rank], kGatheredAtOnce);
      EXPECT_EQ(taken[rank], taken[0]);
    }
    EXPECT_EQ(taken[0].size(), kMax + kMax / 2 + (count > 2 ? kMax / 3 : 0));
  }
}

TEST(Ranks, WhatIsSoOnOneRankIsSoOnAny) {
  for (const std::size_t count : {1U, 3U}) {
    VirtualRanks::run(count, [&](const Ranks& ranks) {
      EXPECT_TRUE(is_any(ranks, ranks.rank + 1 == count));
      EXPECT_FALSE(is_any(ranks, false));
    });
  }
}

}  // namespace
}  // namespace fluxel
