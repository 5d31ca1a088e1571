#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/element.hpp"
#include "core/rgb.hpp"
#include "formfactor/pair_rule.hpp"

namespace fluxel {

/// Elements as structure of arrays, padded with elements of no area to whole tiles; in a unit of length that
/// makes the largest coordinate about 1.
struct PairColumns {
  std::vector<float> x, y, z;  ///< centroids
  std::vector<float> normal_x, normal_y, normal_z;
  std::vector<float> area;
  std::vector<float> elongation_x, elongation_y, elongation_z;  ///< twice that of SecondMoments
  std::vector<float> spread;                                    ///< four times that of SecondMoments
  std::vector<float>
      constant;  ///< what the element adds to c of the second-order term in formfactor/pair_rule
  std::vector<float> least_r2;  ///< what it adds to the least r^2

  explicit PairColumns(std::span<const Element> elements);
  [[nodiscard]] std::size_t padded() const { return x.size(); }
};

/// A_j B_j, with A_j as in PairColumns, in single precision for each colour, of fronts and (in two-sided
/// scenes) backs, padded likewise.
struct ColumnPower {
  std::array<std::array<std::vector<float>, kChannels>, 2> of;  ///< [side][channel]
};

/// Irradiance of a row's front and back.
struct RowIrradiance {
  Rgb front{0};
  Rgb back{0};
};

/// Columns whose sums stay in single precision before they are added up in double.
inline constexpr std::size_t kBlockTiles = 8;

/// sum_j F_ij B_j of row i over the tiles [first_tile, first_tile + words.size()), words.size() at most
/// kBlockTiles. Word t holds the visibility bits of the row against tile first_tile + t. The same value for
/// the same arguments on one instruction set, chosen at run time.
[[nodiscard]] RowIrradiance gather_row(PairRule rule, bool two_sided, const PairColumns& columns,
                                       const ColumnPower& power, std::size_t row, std::size_t first_tile,
                                       std::span<const std::uint64_t> words);

/// Name of the instruction set in use, as "AVX3".
[[nodiscard]] std::string pair_kernel_target();

}  // namespace fluxel
