#include "mpi_master/communication/machine.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <string>
#include <thread>

#include "world.hpp"

namespace fluxel::test {
namespace {

// Here all ranks run on one host, unbound.
TEST(RankPlaces, AllRanksKnowWhereEachRuns) {
  const std::vector<RankPlace> places = rank_places(world(), 3);
  ASSERT_EQ(places.size(), ranks());
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  for (const RankPlace& place : places) {
    EXPECT_EQ(place.host, host.data());
    EXPECT_EQ(place.ranks_on_host, world().size());
    EXPECT_EQ(place.threads, 3) << "what was asked for";
    EXPECT_FALSE(place.cpus.empty());
  }
}

TEST(RankPlaces, RanksDivideTheCpusThatTheyShare) {
  int threads = 0;
  for (const RankPlace& place : rank_places(world(), 0)) {
    EXPECT_GE(place.threads, 1);
    threads += place.threads;
  }
  EXPECT_LE(threads, std::max(world().size(), static_cast<int>(std::thread::hardware_concurrency())));
}

// What a launcher does that binds all ranks to the same CPU.
TEST(RankPlaces, BoundRanksAreSeenWithWhatIsIdle) {
  cpu_set_t before, one;
  ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  int first = 0;
  while (!CPU_ISSET(first, &before)) ++first;
  CPU_ZERO(&one);
  CPU_SET(first, &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  const std::vector<RankPlace> places = rank_places(world(), 0);
  cpu_set_t after;
  sched_getaffinity(0, sizeof after, &after);
  EXPECT_TRUE(CPU_EQUAL(&after, &one)) << "looking must not unbind";
  ASSERT_EQ(sched_setaffinity(0, sizeof before, &before), 0);
  for (const RankPlace& place : places) {
    EXPECT_EQ(place.cpus, std::to_string(first));
    EXPECT_EQ(place.cpu_count, 1);
    EXPECT_EQ(place.threads, 1);
    EXPECT_TRUE(place.one_core);
    EXPECT_EQ(place.idle_cpus_on_host, CPU_COUNT(&before) - 1);
  }
  EXPECT_EQ(rank_places(world(), 0).front().idle_cpus_on_host, 0) << "none is idle where ranks are unbound";
}

TEST(Memory, PeakAndWhatIsLeftAreOfTheRightSize) {
  EXPECT_GT(peak_resident_bytes(), std::uint64_t{1} << 20);
  EXPECT_LT(peak_resident_bytes(), std::uint64_t{1} << 40);
  EXPECT_GT(available_bytes(1), std::uint64_t{1} << 20);
  EXPECT_LT(available_bytes(1000), available_bytes(1));
}

TEST(Memory, CachedFilesOfAControlGroupAreNotUsed) {
  std::string pattern = (std::filesystem::temp_directory_path() / "fluxel-group-XXXXXX").string();
  ASSERT_NE(mkdtemp(pattern.data()), nullptr);
  const std::filesystem::path folder = pattern;
  EXPECT_EQ(bytes_left_in_group(folder), std::numeric_limits<std::uint64_t>::max());
  std::ofstream(folder / "memory.current") << "900\n";
  std::ofstream(folder / "memory.max") << "max\n";
  EXPECT_EQ(bytes_left_in_group(folder), std::numeric_limits<std::uint64_t>::max());
  std::ofstream(folder / "memory.max") << "1000\n";
  EXPECT_EQ(bytes_left_in_group(folder), 100u);
  std::ofstream(folder / "memory.stat") << "anon 200\nfile 700\ninactive_file 600\nactive_file 100\n";
  EXPECT_EQ(bytes_left_in_group(folder), 700u);
  std::ofstream(folder / "memory.max") << "200\n";
  EXPECT_EQ(bytes_left_in_group(folder), 0u);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace fluxel::test
