#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "visibility/coded_tile.hpp"
#include "visibility/tile.hpp"
#include "visibility/tile_code.hpp"

namespace fluxel {

/// A half-open range of tile rows.
struct TileRows {
  std::size_t first = 0;
  std::size_t last = 0;

  [[nodiscard]] bool contains(std::size_t row) const { return first <= row && row < last; }
  [[nodiscard]] std::size_t size() const { return last - first; }
};

/// The tiles that meet a range of rows, all columns: everything that the solve of these rows reads. A tile is
/// held once, as (lower, higher), and read transposed for the other direction. One thread puts; when all has
/// been put, any number may read.
class TileStore {
 public:
  /// `tiles`: tiles on the side of the whole matrix.
  TileStore(std::size_t tiles, TileRows owned);

  [[nodiscard]] const TileRows& owned() const { return owned_; }
  [[nodiscard]] std::size_t tiles() const { return tiles_; }

  /// Takes tile (row, column), column >= row, one of which must be owned; `code`, which must be valid, is
  /// read for TileTag::bits only. Throws std::logic_error for a tile that is here already or does not belong
  /// here, std::length_error as place_of does.
  void put(std::size_t row, std::size_t column, TileTag tag, std::span<const std::byte> code);
  /// The same from the tile's bits.
  void put(std::size_t row, std::size_t column, TileTag tag, const TileBits& bits);

  /// Whether the tile has been put.
  [[nodiscard]] bool has(std::size_t row, std::size_t column) const;

  /// Throws std::logic_error, as does read, for a tile that has not been put.
  [[nodiscard]] TileTag tag(std::size_t row, std::size_t column) const;

  /// The tile (row, column >= row) as it was put. Throws std::logic_error for one that has not been.
  [[nodiscard]] TileView view(std::size_t row, std::size_t column) const;

  /// The tile as seen from `row`, whichever of the two is lower; uniform tiles are filled in.
  void read(std::size_t row, std::size_t column, TileBits& bits) const;

  [[nodiscard]] std::size_t held() const { return held_; }                             ///< tiles put so far
  [[nodiscard]] std::size_t expected() const { return expected_for(tiles_, owned_); }  ///< tiles in all
  [[nodiscard]] std::size_t mixed() const { return mixed_; }  ///< of those held, tiles with bits
  [[nodiscard]] std::size_t bytes() const;  ///< of table and codes, with what the pool has spare

  /// What stands in the table for a code that begins at this unit of the pool. Throws std::length_error where
  /// the table's 32 bits do not suffice (16 GiB of codes on one rank).
  [[nodiscard]] static std::uint32_t place_of(std::size_t unit);

  /// Bytes that a code of `size` bytes takes in the pool.
  [[nodiscard]] static std::size_t pool_bytes(std::size_t size);

  /// Tiles that a store of these rows will hold, each once.
  [[nodiscard]] static std::size_t expected_for(std::size_t tiles, const TileRows& owned);

  /// Bytes of a store whose codes take this much of the pool in all.
  [[nodiscard]] static std::size_t bytes_for(std::size_t tiles, const TileRows& owned,
                                             std::size_t pool_bytes);

  /// The most bytes by which `count` more tiles can make a store grow: each may have to keep raw bits. So the
  /// memory of a strip is bounded before it is computed.
  [[nodiscard]] static std::size_t max_bytes(std::size_t count);

 private:
  [[nodiscard]] std::size_t index_of(std::size_t row, std::size_t column) const;
  [[nodiscard]] std::span<const std::byte> from(std::uint32_t place) const;

  std::size_t tiles_;
  TileRows owned_;
  std::vector<std::uint32_t> entries_;              // owned rows x tiles: a tag, or place_of the code
  std::vector<std::unique_ptr<std::byte[]>> pool_;  // chunks, so that it grows without copying what it has
  std::size_t used_ = 0;                            // of the last chunk [bytes]
  std::size_t held_ = 0;
  std::size_t mixed_ = 0;
};

}  // namespace fluxel
