// Compiled several times: CMake gives the name of the function and the flags.
#include "bench/solver/plain_loop.hpp"

#include <algorithm>
#include <cmath>

namespace fluxel::bench {

namespace {

constexpr std::size_t kWordBits = 64;
constexpr std::size_t kBlockWords = 8;

/// pi F_ij / A_j of row i and column j, whose heights are p and q.
template <PairRule rule>
inline float plain_factor(const PlainColumns& c, std::size_t i, std::size_t j, float dx, float dy, float dz,
                          float p, float q) {
  const float distance2 = dx * dx + dy * dy + dz * dz;
  if constexpr (rule == PairRule::point) return std::abs(p * q) / (distance2 * distance2);
  if constexpr (rule == PairRule::disc)
    return std::abs(p * q) / (distance2 * (distance2 + std::max(c.disc[i], c.disc[j])));
  const float r2 = std::max(distance2, c.least_r2[i] + c.least_r2[j]);
  const float inverse = 1 / r2;
  const float along_i = c.elongation_x[i] * dx + c.elongation_y[i] * dy + c.elongation_z[i] * dz;
  const float along_j = c.elongation_x[j] * dx + c.elongation_y[j] * dy + c.elongation_z[j] * dz;
  const float turned_i = c.elongation_x[i] * c.normal_x[j] + c.elongation_y[i] * c.normal_y[j] +
                         c.elongation_z[i] * c.normal_z[j];
  const float turned_j = c.elongation_x[j] * c.normal_x[i] + c.elongation_y[j] * c.normal_y[i] +
                         c.elongation_z[j] * c.normal_z[i];
  const float g =
      c.normal_x[i] * c.normal_x[j] + c.normal_y[i] * c.normal_y[j] + c.normal_z[i] * c.normal_z[j];
  const float w = 3 * inverse;
  const float h = g - w * p * q;
  const float part_i = p * (c.spread[i] * p * h - along_i * (turned_i - w * q * along_i));
  const float part_j = q * (c.spread[j] * q * h - along_j * (turned_j - w * p * along_j));
  const float bracket = p * q + inverse * (p * q * (c.constant[i] + c.constant[j]) + part_i + part_j);
  return std::max(0.0f, p * q < 0 ? -bracket : bracket) * inverse * inverse;
}

template <PairRule rule, bool two_sided, std::size_t channels>
void plain_word(const PlainColumns& c, std::size_t i, std::size_t first, std::uint64_t word,
                std::array<float, 6>& sums) {
  const float x = c.x[i], y = c.y[i], z = c.z[i];
  const float normal_x = c.normal_x[i], normal_y = c.normal_y[i], normal_z = c.normal_z[i];
  float front_0 = 0, front_1 = 0, front_2 = 0, back_0 = 0, back_1 = 0, back_2 = 0;
#pragma omp simd reduction(+ : front_0, front_1, front_2, back_0, back_1, back_2)
  for (std::size_t k = 0; k < kWordBits; ++k) {
    const std::size_t j = first + k;
    const float dx = c.x[j] - x, dy = c.y[j] - y, dz = c.z[j] - z;
    const float p = normal_x * dx + normal_y * dy + normal_z * dz;
    const float q = c.normal_x[j] * dx + c.normal_y[j] * dy + c.normal_z[j] * dz;
    const float all = plain_factor<rule>(c, i, j, dx, dy, dz, p, q);
    const float factor = ((word >> k) & 1u) != 0 ? all : 0;
    const auto power = [&](std::size_t channel) {
      if constexpr (!two_sided) return c.power[0][channel][j];
      const float of_front = c.power[0][channel][j], of_back = c.power[1][channel][j];
      return q < 0 ? of_front : of_back;
    };
    const float to_front = !two_sided || p > 0 ? factor : 0;
    const float to_back = factor - to_front;
    front_0 += to_front * power(0);
    if constexpr (two_sided) back_0 += to_back * power(0);
    if constexpr (channels == 3) {
      front_1 += to_front * power(1);
      front_2 += to_front * power(2);
      if constexpr (two_sided) {
        back_1 += to_back * power(1);
        back_2 += to_back * power(2);
      }
    }
  }
  sums[0] += front_0;
  sums[1] += front_1;
  sums[2] += front_2;
  sums[3] += back_0;
  sums[4] += back_1;
  sums[5] += back_2;
}

template <PairRule rule, bool two_sided, std::size_t channels>
void plain_row(const PlainColumns& columns, std::size_t row, std::span<const std::uint64_t> words,
               PlainSums& sums) {
  for (std::size_t block = 0; block < words.size(); block += kBlockWords) {
    std::array<float, 6> part{};
    for (std::size_t word = block; word < std::min(words.size(), block + kBlockWords); ++word)
      plain_word<rule, two_sided, channels>(columns, row, word * kWordBits, words[word], part);
    for (std::size_t k = 0; k < part.size(); ++k) sums[k / 3][k % 3] += static_cast<double>(part[k]);
  }
}

template <PairRule rule>
void plain_row_of(const PlainCase& what, const PlainColumns& columns, std::size_t row,
                  std::span<const std::uint64_t> words, PlainSums& sums) {
  if (what.two_sided)
    what.channels == 1 ? plain_row<rule, true, 1>(columns, row, words, sums)
                       : plain_row<rule, true, 3>(columns, row, words, sums);
  else
    what.channels == 1 ? plain_row<rule, false, 1>(columns, row, words, sums)
                       : plain_row<rule, false, 3>(columns, row, words, sums);
}

}  // namespace

#define FLUXEL_JOIN_(a, b) a##b
#define FLUXEL_JOIN(a, b) FLUXEL_JOIN_(a, b)

void FLUXEL_JOIN(plain_row_, FLUXEL_PLAIN_LOOP)(const PlainCase& what, const PlainColumns& columns,
                                                std::size_t row, std::span<const std::uint64_t> words,
                                                PlainSums& sums) {
  switch (what.rule) {
    case PairRule::point:
      return plain_row_of<PairRule::point>(what, columns, row, words, sums);
    case PairRule::disc:
      return plain_row_of<PairRule::disc>(what, columns, row, words, sums);
    case PairRule::moments:
      return plain_row_of<PairRule::moments>(what, columns, row, words, sums);
  }
}

}  // namespace fluxel::bench
