#include "reference/sensor_blocks.hpp"

#include <algorithm>

#include "core/morton.hpp"

namespace fluxel {

namespace {

constexpr std::size_t kEdge = 8;
static_assert(kEdge * kEdge == SensorBlocks::kSize);

}  // namespace

SensorBlocks SensorBlocks::consecutive(std::size_t sensors) { return {sensors, 0}; }

SensorBlocks SensorBlocks::squares(std::size_t columns, std::size_t rows) {
  SensorBlocks blocks(columns * rows, columns);
  for (std::uint32_t y = 0; y * kEdge < rows; ++y)
    for (std::uint32_t x = 0; x * kEdge < columns; ++x) blocks.squares_.push_back({x, y});
  std::ranges::sort(blocks.squares_, {}, [](const auto& square) { return morton(square[0], square[1]); });
  return blocks;
}

std::size_t SensorBlocks::count() const {
  return columns_ > 0 ? squares_.size() : (sensors_ + kSize - 1) / kSize;
}

std::vector<std::size_t> SensorBlocks::sensors(std::size_t block) const {
  std::vector<std::size_t> list;
  list.reserve(kSize);
  if (columns_ == 0) {
    for (std::size_t k = block * kSize; k < std::min((block + 1) * kSize, sensors_); ++k) list.push_back(k);
    return list;
  }
  const std::size_t rows = sensors_ / columns_;
  const std::size_t left = squares_[block][0] * kEdge, top = squares_[block][1] * kEdge;
  for (std::size_t y = top; y < std::min(top + kEdge, rows); ++y)
    for (std::size_t x = left; x < std::min(left + kEdge, columns_); ++x) list.push_back(y * columns_ + x);
  return list;
}

BlockedSensors SensorBlocks::share(std::size_t rank, std::size_t ranks) const {
  BlockedSensors mine;
  for (std::size_t block = rank; block < count(); block += ranks) {
    const std::vector<std::size_t> some = sensors(block);
    mine.sensors.insert(mine.sensors.end(), some.begin(), some.end());
    mine.ends.push_back(mine.sensors.size());
  }
  return mine;
}

}  // namespace fluxel
