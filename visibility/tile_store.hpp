#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "visibility/tile.hpp"

namespace fluxel {

/// A half-open range of tile rows.
struct TileRows {
  std::size_t first = 0;
  std::size_t last = 0;

  [[nodiscard]] bool contains(std::size_t row) const { return first <= row && row < last; }
  [[nodiscard]] std::size_t size() const { return last - first; }
};

/// The tiles that meet a range of rows, all columns: everything that the solve of these rows reads. A tile is
/// held once, as (lower, higher), and read transposed for the other direction.
class TileStore {
 public:
  /// `tiles`: tiles on the side of the whole matrix.
  TileStore(std::size_t tiles, TileRows owned);

  [[nodiscard]] const TileRows& owned() const { return owned_; }
  [[nodiscard]] std::size_t tiles() const { return tiles_; }

  /// Takes tile (row, column), column >= row, one of which must be owned; `bits` is read for TileTag::bits
  /// only. Throws std::logic_error for a tile that is here already.
  void put(std::size_t row, std::size_t column, TileTag tag, const TileBits& bits);

  /// Throws std::logic_error, as does read, for a tile that has not been put.
  [[nodiscard]] TileTag tag(std::size_t row, std::size_t column) const;

  /// The tile as seen from `row`, whichever of the two is lower; uniform tiles are filled in.
  void read(std::size_t row, std::size_t column, TileBits& bits) const;

  [[nodiscard]] std::size_t held() const { return held_; }    ///< tiles put so far
  [[nodiscard]] std::size_t expected() const;                 ///< tiles that will be put in all
  [[nodiscard]] std::size_t mixed() const { return mixed_; }  ///< of those held, tiles with bits
  [[nodiscard]] std::size_t bytes() const;                    ///< of tags and bits

  /// What stands in the table for mixed tile number `mixed`, counted from 0. Throws std::length_error where
  /// the table's 32 bits do not suffice (2 TiB of bits on one rank).
  [[nodiscard]] static std::uint32_t slot_of(std::size_t mixed);

  /// Bytes of a store with this many mixed tiles.
  [[nodiscard]] static std::size_t bytes_for(std::size_t tiles, const TileRows& owned, std::size_t mixed);

 private:
  [[nodiscard]] std::uint32_t& entry(std::size_t row, std::size_t column);
  [[nodiscard]] std::uint32_t entry(std::size_t row, std::size_t column) const;

  static constexpr std::size_t kChunk = 1024;  // tiles; the pool grows without copying what it has

  std::size_t tiles_;
  TileRows owned_;
  std::vector<std::uint32_t> entries_;  // owned rows x tiles: a tag, or kFirstSlot + place in the pool
  std::vector<std::unique_ptr<TileBits[]>> pool_;
  std::size_t held_ = 0;
  std::size_t mixed_ = 0;
};

}  // namespace fluxel
