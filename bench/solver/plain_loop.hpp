#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "formfactor/pair_rule.hpp"

namespace fluxel::bench {

/// What the plain loop reads of the columns: an array for each number, power as [side][channel].
struct PlainColumns {
  const float *x, *y, *z;
  const float *normal_x, *normal_y, *normal_z;
  const float* disc;
  const float *elongation_x, *elongation_y, *elongation_z;
  const float *variance4, *constant, *least_r2;
  std::array<std::array<const float*, 3>, 2> power;
};

struct PlainCase {
  PairRule rule;
  bool two_sided;
  std::size_t channels;  ///< 1 or 3
};

/// The same sums as gather_block's, of row `row` over all words' columns, as one would write them down: a
/// loop over the columns of a word that the compiler turns into vector code, a bit taken out for each pair.
/// Single precision inside 512 columns, double across; adds to [side][channel].
using PlainSums = std::array<std::array<double, 3>, 2>;

// One source, compiled with the project's own flags and for each instruction set. The first takes a bit by a
// shift, which the project's flags have no vector code for; the others by a table.
void plain_row_shifts(const PlainCase& what, const PlainColumns& columns, std::size_t row,
                      std::span<const std::uint64_t> words, PlainSums& sums);
void plain_row_as_built(const PlainCase& what, const PlainColumns& columns, std::size_t row,
                        std::span<const std::uint64_t> words, PlainSums& sums);
void plain_row_sse4(const PlainCase& what, const PlainColumns& columns, std::size_t row,
                    std::span<const std::uint64_t> words, PlainSums& sums);
void plain_row_avx2(const PlainCase& what, const PlainColumns& columns, std::size_t row,
                    std::span<const std::uint64_t> words, PlainSums& sums);
void plain_row_avx512(const PlainCase& what, const PlainColumns& columns, std::size_t row,
                      std::span<const std::uint64_t> words, PlainSums& sums);

}  // namespace fluxel::bench
