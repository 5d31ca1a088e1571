// Compiled several times: CMake gives the name of the function and the flags.
#include "bench/solver/plain_loop.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace fluxel::bench {

namespace {

// A word is taken in halves and a bit by a table: shifts by different amounts, and 64-bit ones beside 32-bit
// numbers, keep the compiler from vectors on the older sets.
constexpr int kHalfBits = 32;
constexpr std::size_t kHalvesOfWord = 2;
constexpr std::array<std::uint32_t, kHalfBits> kBit = [] {
  std::array<std::uint32_t, kHalfBits> bits{};
  for (std::size_t k = 0; k < kHalfBits; ++k) bits[k] = std::uint32_t{1} << k;
  return bits;
}();
constexpr std::size_t kBlockWords = 8;

inline bool bit_is_set([[maybe_unused]] std::uint32_t half, [[maybe_unused]] const std::uint32_t* bit,
                       int k) {
#ifdef FLUXEL_PLAIN_SHIFTS
  return (half >> k & 1u) != 0;
#else
  return (half & bit[k]) != 0;
#endif
}

// std::max goes through references and a choice by ?: may become a jump: both keep the compiler from vectors.
inline float larger(float a, float b) { return a > b ? a : b; }
inline float kept_if(bool condition, float value) {
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(value) & -static_cast<std::uint32_t>(condition));
}

template <PairRule rule, bool two_sided, std::size_t channels>
void plain_half(const PlainColumns& c, std::size_t i, std::size_t first, std::uint32_t half,
                std::array<float, 6>& sums) {
  // All that is one value for the loop, and where its arrays begin: what stands behind a reference might
  // change, for all that the compiler knows.
  const float x_i = c.x[i], y_i = c.y[i], z_i = c.z[i];
  const float nx_i = c.normal_x[i], ny_i = c.normal_y[i], nz_i = c.normal_z[i];
  const float ex_i = c.elongation_x[i], ey_i = c.elongation_y[i], ez_i = c.elongation_z[i];
  const float disc_i = c.disc[i], variance4_i = c.variance4[i], constant_i = c.constant[i],
              least_i = c.least_r2[i];
  const float *x = c.x + first, *y = c.y + first, *z = c.z + first;
  const float *nx = c.normal_x + first, *ny = c.normal_y + first, *nz = c.normal_z + first;
  const float *ex = c.elongation_x + first, *ey = c.elongation_y + first, *ez = c.elongation_z + first;
  const float *disc = c.disc + first, *variance4 = c.variance4 + first, *constant = c.constant + first;
  const float* least = c.least_r2 + first;
  const float *front_power_0 = c.power[0][0] + first, *back_power_0 = c.power[1][0] + first;
  const float *front_power_1 = c.power[0][1] + first, *back_power_1 = c.power[1][1] + first;
  const float *front_power_2 = c.power[0][2] + first, *back_power_2 = c.power[1][2] + first;
  const std::uint32_t* bit = kBit.data();
  float front_0 = 0, front_1 = 0, front_2 = 0, back_0 = 0, back_1 = 0, back_2 = 0;
#pragma omp simd reduction(+ : front_0, front_1, front_2, back_0, back_1, back_2)
  for (int k = 0; k < kHalfBits; ++k) {
    const float dx = x[k] - x_i, dy = y[k] - y_i, dz = z[k] - z_i;
    const float p = nx_i * dx + ny_i * dy + nz_i * dz;
    const float q = nx[k] * dx + ny[k] * dy + nz[k] * dz;
    const float distance2 = dx * dx + dy * dy + dz * dz;
    float all;  // pi F_ij / A_j
    if constexpr (rule == PairRule::point) {
      all = std::abs(p * q) / (distance2 * distance2);
    } else if constexpr (rule == PairRule::disc) {
      all = std::abs(p * q) / (distance2 * (distance2 + larger(disc_i, disc[k])));
    } else {
      const float inverse = 1 / larger(distance2, least_i + least[k]);
      const float along_i = ex_i * dx + ey_i * dy + ez_i * dz;
      const float along_k = ex[k] * dx + ey[k] * dy + ez[k] * dz;
      const float turned_i = ex_i * nx[k] + ey_i * ny[k] + ez_i * nz[k];
      const float turned_k = ex[k] * nx_i + ey[k] * ny_i + ez[k] * nz_i;
      const float w = 3 * inverse;
      const float h = nx_i * nx[k] + ny_i * ny[k] + nz_i * nz[k] - w * p * q;
      const float part_i = p * (variance4_i * p * h - along_i * (turned_i - w * q * along_i));
      const float part_k = q * (variance4[k] * q * h - along_k * (turned_k - w * p * along_k));
      const float bracket = p * q + inverse * (p * q * (constant_i + constant[k]) + part_i + part_k);
      all = larger(0.0f, std::copysign(1.0f, p * q) * bracket) * inverse * inverse;
    }
    const float factor = kept_if(bit_is_set(half, bit, k), all);
    if constexpr (two_sided) {
      const float to_front = kept_if(p > 0, factor), to_back = kept_if(p <= 0, factor);
      const auto sent = [q](float from_front, float from_back) {
        return kept_if(q < 0, from_front) + kept_if(q >= 0, from_back);
      };
      const float power_0 = sent(front_power_0[k], back_power_0[k]);
      front_0 += to_front * power_0;
      back_0 += to_back * power_0;
      if constexpr (channels == 3) {
        const float power_1 = sent(front_power_1[k], back_power_1[k]);
        const float power_2 = sent(front_power_2[k], back_power_2[k]);
        front_1 += to_front * power_1;
        front_2 += to_front * power_2;
        back_1 += to_back * power_1;
        back_2 += to_back * power_2;
      }
    } else {
      front_0 += factor * front_power_0[k];
      if constexpr (channels == 3) {
        front_1 += factor * front_power_1[k];
        front_2 += factor * front_power_2[k];
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
      for (std::size_t h = 0; h < kHalvesOfWord; ++h)
        plain_half<rule, two_sided, channels>(columns, row, (word * kHalvesOfWord + h) * kHalfBits,
                                              static_cast<std::uint32_t>(words[word] >> (h * kHalfBits)),
                                              part);
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
