#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/rgb.hpp"

namespace fluxel {

// How samples are dealt to blocks of sensors without making their means biased. A block that stops when its
// own numbers look good stops early where light that is seldom met has been missed so far: its mean is too
// low on average. Here one half of the randomisations decides on the samples of the other, which knows
// nothing of it. But then its own number of samples is decided by the other, and were it to tell of all its
// samples, each half would decide on itself by way of the other. So it tells of its first samples alone, as
// many as every block has whatever the values are.

/// Samples of each randomisation: of those of the first half, and of the second.
using HalfSamples = std::array<std::uint32_t, 2>;

/// What is known of a block when samples are dealt, as each half tells.
struct BlockSpread {
  std::uint64_t sensors = 0;      ///< those that weigh something
  std::array<Rgb, 2> light{};     ///< weight times value, of its sensors together
  std::array<Rgb, 2> variance{};  ///< of a sample: weight times variance, in the mean of its sensors
};

/// Samples that every sensor is given before any is given more.
inline constexpr std::uint32_t kMinSamples = 4;

/// Samples that every block has where the mean of all is `mean`. A block whose first samples told nothing of
/// the light that varies there has them, too.
[[nodiscard]] std::uint32_t least_samples(std::uint32_t mean);

/// The first samples by which BlockSpread::variance tells where the mean was `mean`: a power of two, of
/// which all blocks have as many.
[[nodiscard]] std::uint32_t pilot_samples(std::uint32_t mean);

/// Adds to `samples` until their mean over all sensors is `mean`; each half by what the other tells. Each
/// step goes to the block where a sample more lowers the squared error of all most, of the channel in which
/// it is largest over the mean (after Neyman 1934, who has samples in proportion to the root of the variance;
/// here it is the power 0.4, since even points err less). Steps are a quarter of a power of two, since Sobol
/// points are even by such numbers; the last one takes what is left. Not all of it is dealt where blocks are
/// so few that a sample of one is more than what is left.
void deal_samples(std::uint32_t mean, std::span<const BlockSpread> spreads, std::span<HalfSamples> samples);

}  // namespace fluxel
