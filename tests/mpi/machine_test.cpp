#include "mpi_master/machine.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
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

TEST(LaunchWarnings, BoundRanksAndLonelyCopiesAreNamed) {
  const std::vector<RankPlace> unbound{{"a", "0-3", 2, 2}, {"a", "0-3", 2, 2}};
  EXPECT_TRUE(launch_warnings(unbound, 0).empty());
  const std::vector<RankPlace> bound{{"a", "0", 1, 0}, {"a", "1", 1, 0}};
  const auto warnings = launch_warnings(bound, 4);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[0].find("--bind-to none"), std::string::npos);
  EXPECT_NE(warnings[1].find("4 threads share one CPU"), std::string::npos);
  // The launcher says how many it started: a world of one rank among several is a copy that knows of no
  // other.
  const std::vector<RankPlace> lonely{{"a", "0-3", 4, 1}};
  EXPECT_EQ(launch_warnings(lonely, 0).size(), world().size() > 1 ? 1u : 0u);
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
