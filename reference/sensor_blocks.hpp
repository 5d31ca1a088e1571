#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fluxel {

/// Sensors, block after block.
struct BlockedSensors {
  std::vector<std::size_t> sensors;
  std::vector<std::size_t> ends;  ///< of each block, in `sensors`
};

/// Groups of at most kSize sensors that are near each other: a group is measured by one rank and dealt
/// samples as one. Each sensor is in one of them.
class SensorBlocks {
 public:
  static constexpr std::size_t kSize = 64;

  /// Of sensors that follow one another.
  [[nodiscard]] static SensorBlocks consecutive(std::size_t sensors);
  /// Squares of 8 x 8 pixels or cells, smaller at the right and the lower edge, along Morton's curve: ranks
  /// that take blocks in turn have some of every region. Sensors are numbered by rows.
  [[nodiscard]] static SensorBlocks squares(std::size_t columns, std::size_t rows);

  [[nodiscard]] std::size_t count() const;
  [[nodiscard]] std::vector<std::size_t> sensors(std::size_t block) const;
  /// Of blocks `rank`, `rank` + `ranks` and so on.
  [[nodiscard]] BlockedSensors share(std::size_t rank, std::size_t ranks) const;

 private:
  SensorBlocks(std::size_t sensors, std::size_t columns) : sensors_(sensors), columns_(columns) {}

  std::size_t sensors_;
  std::size_t columns_;                                ///< 0: blocks are consecutive
  std::vector<std::array<std::uint32_t, 2>> squares_;  ///< column and row of squares, in their order
};

}  // namespace fluxel
