#pragma once

#include <cstddef>
#include <cstdint>

#include "visibility/cuda/portable.hpp"
#include "visibility/cuda/tile_scene.hpp"

namespace fluxel::cuda {

/// As PairRule of formfactor/pair_rule.
enum class Rule { point, disc, moments };

/// A tile's columns are lines of kTile numbers, those of TileColumns in solver/pair_kernel: a vector takes
/// three.
inline constexpr std::uint32_t kCentroidLine = 0, kNormalLine = 3, kDiscLine = 6, kElongationLine = 7,
                               kVarianceLine = 10, kConstantLine = 11, kMinR2Line = 12, kColumnLines = 13;

/// What the rows of a tile see of the columns of another, in 32 bits: nothing, all, or what the tile of bits
/// with a number says; and whether PairRule::point is enough for them.
struct TileEntry {
  std::uint32_t code;

  static constexpr std::uint32_t kNothing = 0, kAll = 1, kFirstBits = 2;

  FLUXEL_PORTABLE static constexpr TileEntry of(std::uint32_t seen, bool far) {
    return {2 * seen + static_cast<std::uint32_t>(far)};
  }
  [[nodiscard]] FLUXEL_PORTABLE constexpr std::uint32_t seen() const { return code / 2; }
  [[nodiscard]] FLUXEL_PORTABLE constexpr bool is_far() const { return code % 2 != 0; }
};

/// All that gathering reads, as plain arrays in the memory of the host or of a device.
struct RowView {
  const float* columns;       ///< of each tile kColumnLines lines
  const float* power;         ///< of each tile a line a side and channel, as ColumnPower has them
  const std::uint8_t* sends;  ///< of each tile: 0 where its power is all zero
  const TileEntry* entries;   ///< of each held tile row, an entry a tile of columns
  const std::uint64_t* bits;  ///< kTile words a tile, word r of the lower tile row, bit c of the higher
  std::uint32_t tiles;        ///< on the matrix's side
  std::uint32_t first_row;    ///< of the tile rows that are held
};

/// What a kernel is compiled for.
template <Rule of_pairs, bool both_sides, std::uint32_t of_light>
struct Kind {
  static constexpr Rule kRule = of_pairs;
  static constexpr bool kTwoSided = both_sides;
  static constexpr std::uint32_t kChannels = of_light;
  static constexpr std::uint32_t kLines = (both_sides ? 2 : 1) * of_light;  ///< of power and of sums
};

template <Rule rule, class Function>
void with_kind_of(bool two_sided, std::uint32_t channels, Function f) {
  if (two_sided) {
    channels == 1 ? f(Kind<rule, true, 1>()) : f(Kind<rule, true, 3>());
  } else {
    channels == 1 ? f(Kind<rule, false, 1>()) : f(Kind<rule, false, 3>());
  }
}

/// f(Kind) for one or three channels.
template <class Function>
void with_kind(Rule rule, bool two_sided, std::uint32_t channels, Function f) {
  switch (rule) {
    case Rule::point:
      return with_kind_of<Rule::point>(two_sided, channels, f);
    case Rule::disc:
      return with_kind_of<Rule::disc>(two_sided, channels, f);
    case Rule::moments:
      return with_kind_of<Rule::moments>(two_sided, channels, f);
  }
}

/// The columns of a row are summed in slices, each by a warp. They depend on the size of the matrix alone, so
/// that sums do not depend on who makes them and with which other rows: enough of them for a large device
/// with a few thousand elements, and few beside the columns with many.
inline constexpr std::uint32_t kMinTilesOfSlice = 4, kMaxSlices = 64;

FLUXEL_PORTABLE constexpr std::uint32_t tiles_of_slice(std::uint32_t tiles) {
  const std::uint32_t wanted = (tiles + kMaxSlices - 1) / kMaxSlices;
  return wanted > kMinTilesOfSlice ? wanted : kMinTilesOfSlice;
}
FLUXEL_PORTABLE constexpr std::uint32_t slices_of(std::uint32_t tiles) {
  return (tiles + tiles_of_slice(tiles) - 1) / tiles_of_slice(tiles);
}

}  // namespace fluxel::cuda
