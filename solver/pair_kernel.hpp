#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/element.hpp"
#include "core/rgb.hpp"
#include "formfactor/pair_rule.hpp"
#include "solver/column_power.hpp"
#include "visibility/tile.hpp"

namespace fluxel {

/// The elements of a tile as structure of arrays.
struct alignas(64) TileColumns {
  TileFloats x, y, z;  ///< centroids
  TileFloats normal_x, normal_y, normal_z;
  TileFloats disc;                                      ///< area over pi
  TileFloats elongation_x, elongation_y, elongation_z;  ///< twice that of SecondMoments
  TileFloats variance4;                                 ///< four times that of SecondMoments
  TileFloats constant;  ///< what the element adds to c of the second-order term in formfactor/pair_rule
  TileFloats least_r2;  ///< what it adds to the least r^2
};

/// All elements, padded with elements of no area to whole tiles; in a unit of length that makes the largest
/// coordinate about 1.
struct PairColumns {
  std::vector<TileColumns> tiles;
  std::vector<float> area;  ///< of the elements alone, without padding

  explicit PairColumns(std::span<const Element> elements);
};

/// The same for those who read it, wherever it is held; what holds it must outlive this.
struct PairColumnsView {
  std::span<const TileColumns> tiles;
  std::span<const float> area;

  PairColumnsView(std::span<const TileColumns> of_tiles, std::span<const float> of_area)
      : tiles(of_tiles), area(of_area) {}
  PairColumnsView(const PairColumns& columns) : PairColumnsView(columns.tiles, columns.area) {}
};

/// Makes the tiles [first, last) of PairColumns in arrays that have room for all of it.
void make_columns(std::span<const Element> elements, std::size_t first, std::size_t last,
                  std::span<TileColumns> tiles, std::span<float> area);

/// Irradiance of a row's front and back, in each channel: [side][channel].
template <std::size_t channels>
using RowIrradiance = std::array<std::array<double, channels>, 2>;

/// Columns whose sums stay in single precision before they are added up in double.
inline constexpr std::size_t kBlockTiles = 8;

/// A tile of columns as the rows of one tile row see it: word r of `bits` is that of the row r.
struct SeenTile {
  std::size_t tile = 0;
  const TileBits* bits = nullptr;
};

/// What the kernel evaluates: pairs of the rows (elements) from first_row on, all of one tile row, with at
/// most kBlockTiles tiles.
struct PairBlock {
  PairRule rule;
  bool two_sided;
  PairColumnsView columns;
  const ColumnPower& power;
  std::size_t first_row;
  std::span<const SeenTile> tiles;
};

/// Adds sum_j F_ij B_j over the block's columns to each row of `sums`. What a row gets is the same value for
/// the same tiles and bits, whichever rows share the call and whatever the number of channels, on one
/// instruction set (visibility/instruction_set). A power that is not finite reaches
/// all rows that see it, and may reach others.
void gather_block(const PairBlock& block, std::span<RowIrradiance<kChannels>> sums);
void gather_block(const PairBlock& block, std::span<RowIrradiance<1>> sums);

}  // namespace fluxel
