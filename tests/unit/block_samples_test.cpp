#include "reference/block_samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace fluxel {
namespace {

/// A block of 64 sensors that both halves tell the same of.
BlockSpread block_of(double variance) { return {64, {Rgb(64), Rgb(64)}, {Rgb(variance), Rgb(variance)}}; }

double mean_samples(const std::vector<HalfSamples>& samples, std::size_t half) {
  double sum = 0;
  for (const HalfSamples& of_block : samples) sum += of_block[half];
  return sum / static_cast<double>(samples.size());
}

TEST(BlockSamples, GoToThePowerOfTheVariance) {
  // Variances of 1, 32 and 1024: samples of 1, 4 and 16 by the power 0.4.
  const std::vector<BlockSpread> spreads{block_of(1), block_of(32), block_of(1024)};
  std::vector<HalfSamples> samples(3, HalfSamples{4, 4});
  deal_samples(7000, spreads, samples);
  EXPECT_EQ(samples[0][0], least_samples(7000)) << "1000 would do for it";
  const double ratio = static_cast<double>(samples[2][0]) / samples[1][0];
  EXPECT_NEAR(ratio, 4, 4 * 0.25) << "to a step";
  EXPECT_NEAR(mean_samples(samples, 0), 7000, 1);
  EXPECT_NEAR(mean_samples(samples, 1), 7000, 1);
}

TEST(BlockSamples, AHalfDecidesOnTheOtherAlone) {
  std::vector<BlockSpread> spreads(5, block_of(1));
  std::vector<HalfSamples> before(5, HalfSamples{4, 4}), after = before;
  deal_samples(16, spreads, before);
  spreads[3].variance[0] = Rgb(100);
  spreads[3].light[0] = Rgb(1);
  deal_samples(16, spreads, after);
  for (std::size_t block = 0; block < 5; ++block) EXPECT_EQ(after[block][0], before[block][0]) << block;
  EXPECT_GT(after[3][1], before[3][1]);
  EXPECT_LT(after[0][1], before[0][1]);
}

TEST(BlockSamples, WhatVariesNowhereIsDealtEvenly) {
  const std::vector<BlockSpread> dark(8, BlockSpread{64, {Rgb(0), Rgb(0)}, {Rgb(0), Rgb(0)}});
  std::vector<HalfSamples> samples(8, HalfSamples{4, 4});
  deal_samples(32, dark, samples);
  for (const HalfSamples& of_block : samples) EXPECT_EQ(of_block, (HalfSamples{32, 32}));
}

TEST(BlockSamples, TheChannelThatIsWorstOverItsMeanCounts) {
  // Blue is dim: its variance of 1 is more over its mean than that of 50 of red.
  const Rgb light(100, 100, 1);
  std::vector<BlockSpread> spreads(4, BlockSpread{64, {light, light}, {Rgb(0), Rgb(0)}});
  spreads[1].variance = {Rgb(50, 0, 0), Rgb(50, 0, 0)};
  spreads[2].variance = {Rgb(0, 0, 1), Rgb(0, 0, 1)};
  std::vector<HalfSamples> samples(4, HalfSamples{4, 4});
  deal_samples(8, spreads, samples);
  EXPECT_EQ(samples[1][0], 4u);
  EXPECT_GT(samples[2][0], 16u);
}

TEST(BlockSamples, EveryBlockHasItsLeastAndNoneLosesAny) {
  std::vector<BlockSpread> spreads(64, block_of(0));
  spreads[9] = block_of(1e6);
  spreads[10].sensors = 0;
  std::vector<HalfSamples> samples(64, HalfSamples{});
  std::vector<HalfSamples> last;
  for (std::uint32_t mean = 4; mean < 300; mean += std::max(mean / 8, 1u)) {
    last = samples;
    deal_samples(mean, spreads, samples);
    for (std::size_t block = 0; block < 64; ++block)
      for (std::size_t half = 0; half < 2; ++half) {
        ASSERT_GE(samples[block][half], least_samples(mean));
        ASSERT_GE(samples[block][half], last[block][half]);
        ASSERT_GE(samples[block][half], pilot_samples(mean));
      }
    double sum = 0;
    for (std::size_t block = 0; block < 64; ++block)
      if (block != 10) sum += samples[block][0];
    EXPECT_LE(sum / 63, mean);
    EXPECT_GT(sum / 63, mean - 1.0);
  }
  EXPECT_GT(samples[9][0], 64u * 100);
}

TEST(BlockSamples, OneBlockHasTheMean) {
  std::vector<HalfSamples> samples(1, HalfSamples{4, 4});
  for (const std::uint32_t mean : {5u, 6u, 9u, 100u, 101u}) {
    deal_samples(mean, std::vector{BlockSpread{1, {Rgb(1), Rgb(1)}, {Rgb(1), Rgb(1)}}}, samples);
    EXPECT_EQ(samples[0], (HalfSamples{mean, mean}));
  }
}

// More than a block can count is not asked of it.
TEST(BlockSamples, EndsWhereNumbersEnd) {
  std::vector<HalfSamples> samples(2, HalfSamples{4, 4});
  const std::vector<BlockSpread> spreads{block_of(1), block_of(0)};
  deal_samples(4294967295u, spreads, samples);
  EXPECT_EQ(samples[0], (HalfSamples{4294967295u, 4294967295u}));
}

}  // namespace
}  // namespace fluxel
