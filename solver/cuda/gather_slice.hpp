#pragma once

#include "solver/cuda/pair_factor.hpp"
#include "visibility/cuda/warp.hpp"

namespace fluxel::cuda {

/// What a column sends, a number a line.
template <std::uint32_t lines>
struct alignas(lines < 3 ? 4 * lines : 16) PowerOf {
  float line[lines];
};

/// A tile of columns as all lanes of a warp read it, column after column.
template <class Kind>
struct SliceMemory {
  ElementOf<Kind::kRule> column[kTile];
  PowerOf<Kind::kLines> power[kTile];
  std::uint64_t seers[kTile];  ///< bit r: the row r sees the column
};

/// Each lane has two rows of the tile row: what it loads of a column is used twice.
inline constexpr std::uint32_t kRowsOfLane = kTile / kLanes;

template <class Kind>
struct LaneRows {
  ElementOf<Kind::kRule> element[kRowsOfLane];
  double sum[kRowsOfLane][Kind::kLines];
};

/// Word r, bit c becomes word c, bit r; as transpose in visibility/tile.
FLUXEL_PORTABLE inline void transpose(const Warp& warp, std::uint64_t* words) {
  for (std::uint32_t width = kTile / 2; width > 0; width /= 2) {
    const std::uint64_t lower_halves = ~std::uint64_t{0} / ((std::uint64_t{1} << width) + 1);
    warp.each([&](std::uint32_t lane) {
      const std::uint32_t row = lane / width * 2 * width + lane % width;
      const std::uint64_t swapped = ((words[row] >> width) ^ words[row + width]) & lower_halves;
      words[row] ^= swapped << width;
      words[row + width] ^= swapped;
    });
  }
}

/// Loads a tile of columns as the rows of a tile row see it.
template <class Kind>
FLUXEL_PORTABLE inline void load_tile(const Warp& warp, const RowView& view, std::uint32_t row_tile,
                                      std::uint32_t tile, TileEntry entry, SliceMemory<Kind>& memory) {
  const float* power = view.power + std::size_t{tile} * Kind::kLines * kTile;
  const bool has_bits = entry.seen() >= TileEntry::kFirstBits;
  const std::uint64_t* bits = view.bits;
  if (has_bits) bits += std::size_t{entry.seen() - TileEntry::kFirstBits} * kTile;
  warp.each([&](std::uint32_t lane) {
    for (std::uint32_t c = lane; c < kTile; c += kLanes) {
      memory.column[c] = element_of<Kind::kRule>(view, tile, c);
      PowerOf<Kind::kLines> of_column;
      for (std::uint32_t line = 0; line < Kind::kLines; ++line)
        of_column.line[line] = power[line * kTile + c];
      memory.power[c] = of_column;
      memory.seers[c] = has_bits ? bits[c] : ~std::uint64_t{0};
    }
  });
  // Bits stand with the lower tile row; the tile on the diagonal is symmetric.
  if (has_bits && row_tile < tile) transpose(warp, memory.seers);
}

/// Adds what a column sends to a row, whose sums are those of its front, then those of its back.
template <Rule rule, class Kind>
FLUXEL_PORTABLE inline void add_pair(const ElementOf<Kind::kRule>& row, const ElementOf<Kind::kRule>& column,
                                     const PowerOf<Kind::kLines>& power, bool sees, float* sum) {
  const Pair pair = pair_of(row, column);
  const float factor = pair_factor<rule>(row, column, pair);
  const float seen = sees ? factor : 0.0f;  // the factor of an element and itself is no number
  for (std::uint32_t c = 0; c < Kind::kChannels; ++c) {
    if constexpr (Kind::kTwoSided) {
      const float sent = pair.column_height < 0 ? power.line[c] : power.line[Kind::kChannels + c];
      const bool in_front = pair.row_height > 0;
      sum[c] = std::fma(in_front ? seen : 0.0f, sent, sum[c]);
      sum[Kind::kChannels + c] = std::fma(in_front ? 0.0f : seen, sent, sum[Kind::kChannels + c]);
    } else {
      sum[c] = std::fma(seen, power.line[c], sum[c]);
    }
  }
}

/// Adds what the loaded tile sends: in single precision inside the tile, in double across tiles.
template <Rule rule, class Kind>
FLUXEL_PORTABLE inline void gather_tile(const Warp& warp, const SliceMemory<Kind>& memory,
                                        PerLane<LaneRows<Kind>>& rows) {
  warp.each([&](std::uint32_t lane) {
    LaneRows<Kind>& own = rows[lane];
    float sum[kRowsOfLane][Kind::kLines] = {};
    for (std::uint32_t c = 0; c < kTile; ++c) {
      const std::uint64_t seers = memory.seers[c];
      if (seers == 0) continue;
      const ElementOf<Kind::kRule> column = memory.column[c];
      const PowerOf<Kind::kLines> power = memory.power[c];
      for (std::uint32_t k = 0; k < kRowsOfLane; ++k) {
        const auto of_lanes = static_cast<std::uint32_t>(seers >> k * kLanes);
        add_pair<rule, Kind>(own.element[k], column, power, (of_lanes >> lane & 1u) != 0, sum[k]);
      }
    }
    for (std::uint32_t k = 0; k < kRowsOfLane; ++k)
      for (std::uint32_t line = 0; line < Kind::kLines; ++line)
        own.sum[k][line] += static_cast<double>(sum[k][line]);
  });
}

/// What a slice of the columns sends to the rows of a tile row, by a warp: a line of sums a side and channel.
template <class Kind>
FLUXEL_PORTABLE inline void gather_slice(const Warp& warp, const RowView& view, std::uint32_t row_tile,
                                         std::uint32_t slice, SliceMemory<Kind>& memory, double* sums) {
  PerLane<LaneRows<Kind>> rows;
  warp.each([&](std::uint32_t lane) {
    for (std::uint32_t k = 0; k < kRowsOfLane; ++k)
      rows[lane].element[k] = element_of<Kind::kRule>(view, row_tile, k * kLanes + lane);
  });
  const TileEntry* entries = view.entries + std::size_t{row_tile - view.first_row} * view.tiles;
  const std::uint32_t length = tiles_of_slice(view.tiles);
  const std::uint32_t end = lesser(view.tiles, (slice + 1) * length);
  for (std::uint32_t first = slice * length; first < end; first += kLanes) {
    std::uint32_t sending = warp.ballot([&](std::uint32_t lane) {
      const std::uint32_t tile = first + lane;
      return tile < end && view.sends[tile] != 0 && entries[tile].seen() != TileEntry::kNothing;
    });
    for (; sending != 0; sending &= sending - 1) {
      const std::uint32_t tile = first + lowest_bit(sending);
      const TileEntry entry = entries[tile];
      load_tile(warp, view, row_tile, tile, entry, memory);
      if (Kind::kRule != Rule::point && entry.is_far())
        gather_tile<Rule::point>(warp, memory, rows);
      else
        gather_tile<Kind::kRule>(warp, memory, rows);
    }
  }
  warp.each([&](std::uint32_t lane) {
    for (std::uint32_t k = 0; k < kRowsOfLane; ++k)
      for (std::uint32_t line = 0; line < Kind::kLines; ++line)
        sums[line * kTile + k * kLanes + lane] = rows[lane].sum[k][line];
  });
}

/// A sum of all slices in their order; those of a slice stand `items` numbers behind those of the one before.
FLUXEL_PORTABLE inline double add_slices(const double* of_slices, std::uint32_t slices, std::size_t items) {
  double sum = 0;
  for (std::uint32_t slice = 0; slice < slices; ++slice) sum += of_slices[slice * items];
  return sum;
}

}  // namespace fluxel::cuda
