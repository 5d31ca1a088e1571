#include "mpi_master/communication/shared_pages.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

#include "host_shapes.hpp"
#include "mpi_master/communication/machine.hpp"

namespace fluxel::test {
namespace {

constexpr std::size_t kMany = std::size_t{1} << 23;  // 64 MiB, which malloc gets pages of its own for

std::vector<double> numbers(std::size_t count) {
  std::vector<double> items(count);
  std::iota(items.begin(), items.end(), 1.0);
  return items;
}

/// The leader's; others have as many of their own.
std::vector<double> numbers_of_leader(const Communicator& host, std::size_t count) {
  return host.is_root() ? numbers(count) : std::vector<double>(count, -2);
}

std::size_t share(const Communicator& host, std::vector<double>& items) {
  return share_pages(host, std::as_writable_bytes(std::span(items)));
}

TEST(SharePages, TakesMemoryOnceAHost) {
  for (const HostShape& shape : host_shapes()) {
    SCOPED_TRACE(shape.name);
    const Communicator& host = shape.world.host();
    std::vector<double> items = numbers_of_leader(host, kMany);
    world().barrier();
    const auto before = static_cast<double>(proportional_bytes());
    const std::size_t shared = share(host, items);
    // All look at all pages, and nothing is allocated.
    bool all_there = true;
    for (std::size_t k = 0; k < kMany; ++k) all_there = all_there && items[k] == static_cast<double>(k + 1);
    EXPECT_TRUE(all_there);
    world().barrier();
    const auto after = static_cast<double>(proportional_bytes());
    world().barrier();
    const auto ranks = static_cast<double>(host.size());
    const auto bytes = static_cast<double>(kMany * sizeof(double));
    if (host.size() == 1) {
      EXPECT_EQ(shared, 0U);
    } else {
      EXPECT_GT(shared, kMany * sizeof(double) * 99 / 100);
      // Of all others as much, give or take what the program itself does meanwhile.
      EXPECT_NEAR(before - after, bytes * (1 - 1 / ranks), 0.1 * bytes);
    }
  }
}

TEST(SharePages, WhatARankWritesIsItsOwn) {
  for (const HostShape& shape : host_shapes()) {
    SCOPED_TRACE(shape.name);
    const Communicator& host = shape.world.host();
    std::vector<double> items = numbers_of_leader(host, kMany);
    items.reserve(kMany + 1);
    share(host, items);
    const std::size_t own = 1000 * (static_cast<std::size_t>(host.rank()) + 1);
    items[own] = -1;
    items.push_back(7);
    host.barrier();
    std::vector<double> expected = numbers(kMany);
    expected[own] = -1;
    expected.push_back(7);
    EXPECT_TRUE(items == expected);
    items = {};  // gives the pages back
    host.barrier();
  }
}

TEST(SharePages, CopiesWhatLiesOtherwiseOrIsSmall) {
  const HostShape shape = host_shapes().front();
  const Communicator& host = shape.world.host();
  std::vector<std::byte> items(kMany + ranks());
  // Of each rank one byte further.
  const auto bytes = std::span(items).subspan(own_rank(), kMany);
  if (host.is_root()) std::ranges::fill(bytes, std::byte{42});
  EXPECT_EQ(share_pages(host, bytes), 0U);
  EXPECT_TRUE(std::ranges::all_of(bytes, [](std::byte byte) { return byte == std::byte{42}; }));
  std::vector<double> few = numbers_of_leader(host, 3), none;
  EXPECT_EQ(share(host, few), 0U);
  EXPECT_EQ(share(host, none), 0U);
  EXPECT_EQ(few, (std::vector<double>{1, 2, 3}));
}

}  // namespace
}  // namespace fluxel::test
