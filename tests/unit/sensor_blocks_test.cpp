#include "reference/sensor_blocks.hpp"

#include <gtest/gtest.h>

#include <set>

namespace fluxel {
namespace {

void expect_each_once(const SensorBlocks& blocks, std::size_t sensors) {
  std::multiset<std::size_t> found;
  for (std::size_t rank = 0; rank < 3; ++rank) {
    const BlockedSensors share = blocks.share(rank, 3);
    EXPECT_TRUE(share.ends.empty() ? share.sensors.empty() : share.ends.back() == share.sensors.size());
    found.insert(share.sensors.begin(), share.sensors.end());
  }
  EXPECT_EQ(found.size(), sensors);
  EXPECT_EQ(std::set(found.begin(), found.end()).size(), sensors);
  EXPECT_TRUE(found.empty() || *found.rbegin() == sensors - 1);
}

TEST(SensorBlocks, HoldEachSensorOnce) {
  for (const std::size_t sensors : {0u, 1u, 64u, 65u, 1000u})
    expect_each_once(SensorBlocks::consecutive(sensors), sensors);
  for (const std::size_t columns : {1u, 8u, 13u, 64u})
    for (const std::size_t rows : {1u, 7u, 16u, 41u})
      expect_each_once(SensorBlocks::squares(columns, rows), columns * rows);
}

TEST(SensorBlocks, AreSquaresAlongMortonsCurve) {
  const SensorBlocks blocks = SensorBlocks::squares(20, 16);
  ASSERT_EQ(blocks.count(), 6u);
  // Squares (0, 0), (1, 0), (0, 1), (1, 1), and of the last column, 4 wide.
  EXPECT_EQ(blocks.sensors(1).front(), 8u);
  EXPECT_EQ(blocks.sensors(1)[8], 28u);
  EXPECT_EQ(blocks.sensors(1).size(), 64u);
  EXPECT_EQ(blocks.sensors(2).front(), 160u);
  EXPECT_EQ(blocks.sensors(4).front(), 16u);
  EXPECT_EQ(blocks.sensors(4).size(), 32u);
}

}  // namespace
}  // namespace fluxel
