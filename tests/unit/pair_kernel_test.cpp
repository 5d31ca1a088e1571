#include "solver/pair_kernel.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "formfactor/pair_rule.hpp"
#include "tests/unit/closed_box.hpp"
#include "tests/unit/test_scenes.hpp"
#include "visibility/instruction_set.hpp"
#include "visibility/tile.hpp"

namespace fluxel {
namespace {

using test_scenes::random_elements;

ColumnPower random_power(const PairColumns& columns, bool two_sided, std::size_t channels,
                         std::mt19937& random) {
  ColumnPower power(columns.tiles.size(), two_sided ? 2 : 1, channels);
  for (std::size_t side = 0; side < (two_sided ? 2u : 1u); ++side)
    for (std::size_t c = 0; c < channels; ++c)
      for (std::size_t j = 0; j < columns.area.size(); ++j)
        power.of(j / kTileSize, side, c)[j % kTileSize] =
            columns.area[j] * static_cast<float>(test_scenes::uniform(random, 0, 1));
  return power;
}

/// What one row sees of consecutive tiles.
struct RowOfTiles {
  std::vector<TileBits> bits;
  std::vector<SeenTile> tiles;

  RowOfTiles(std::size_t row, std::size_t first_tile, std::span<const std::uint64_t> words)
      : bits(words.size()) {
    for (std::size_t t = 0; t < words.size(); ++t) {
      bits[t].fill(0);
      bits[t][row % kTileSize] = words[t];
      tiles.push_back({first_tile + t, &bits[t]});
    }
  }
};

template <std::size_t channels = kChannels>
RowIrradiance<channels> gather_row(PairRule rule, bool two_sided, const PairColumns& columns,
                                   const ColumnPower& power, std::size_t row, std::size_t first_tile,
                                   std::span<const std::uint64_t> words) {
  const RowOfTiles seen(row, first_tile, words);
  std::array<RowIrradiance<channels>, 1> sum{};
  gather_block({rule, two_sided, columns, power, row, seen.tiles}, sum);
  return sum[0];
}

/// The plain double loop, over the elements and powers as they are.
RowIrradiance<kChannels> plain_row(PairRule rule, bool two_sided, std::span<const Element> elements,
                                   const PairColumns& columns, ColumnPower& power, std::size_t i,
                                   std::size_t first_tile, std::span<const std::uint64_t> words) {
  RowIrradiance<kChannels> sum{};
  for (std::size_t t = 0; t < words.size(); ++t) {
    for (std::size_t c = 0; c < kTileSize; ++c) {
      if ((words[t] >> c & 1u) == 0) continue;
      const std::size_t j = (first_tile + t) * kTileSize + c;
      const glm::vec3 separation = elements[j].centroid - elements[i].centroid;
      const std::size_t side_of_i = !two_sided || glm::dot(elements[i].normal, separation) > 0 ? 0 : 1;
      const std::size_t side_of_j = !two_sided || glm::dot(elements[j].normal, separation) < 0 ? 0 : 1;
      const double F = pair_form_factor(rule, elements[i], elements[j]);
      for (std::size_t channel = 0; channel < kChannels; ++channel)
        sum[side_of_i][channel] += F * std::numbers::pi *
                                   static_cast<double>(power.of(first_tile + t, side_of_j, channel)[c]) /
                                   static_cast<double>(columns.area[j]);
    }
  }
  return sum;
}

/// A rule, whether sides are two, and the instruction set that is used.
class PairKernel : public testing::TestWithParam<std::tuple<PairRule, bool, Isa>> {
 protected:
  PairRule rule = std::get<0>(GetParam());
  bool two_sided = std::get<1>(GetParam());

  void SetUp() override { use_instruction_set(std::get<2>(GetParam())); }
  void TearDown() override { use_instruction_set(Isa::automatic); }
};

std::uint64_t without(std::uint64_t word, std::size_t bit) { return word & ~(std::uint64_t{1} << bit); }

TEST_P(PairKernel, AgreesWithThePlainDoubleLoop) {
  std::mt19937 random(1);
  std::mt19937_64 random_words(2);
  for (const double reach : {1e-3, 1.0, 700.0}) {
    const std::size_t n = 3 * kTileSize + 17;
    const std::vector<Element> elements = random_elements(n, reach, random);
    const PairColumns columns(elements);
    ColumnPower power = random_power(columns, two_sided, kChannels, random);
    for (const std::size_t row : {std::size_t{0}, std::size_t{70}, n - 1}) {
      for (std::size_t first = 0; first < 4; ++first) {
        std::vector<std::uint64_t> words;
        for (std::size_t tile = first; tile < 4; ++tile)
          words.push_back(random_words() & low_bits(rows_of_tile(tile, n)));
        if (row / kTileSize >= first) {
          std::uint64_t& own = words[row / kTileSize - first];
          own = without(own, row % kTileSize);
        }
        const auto exact = plain_row(rule, two_sided, elements, columns, power, row, first, words);
        const auto H = gather_row(rule, two_sided, columns, power, row, first, words);
        for (std::size_t c = 0; c < kChannels; ++c) {
          // Grazing pairs lose digits in single precision, but they are small in the row.
          const double row_sum = exact[0][c] + exact[1][c];
          EXPECT_NEAR(H[0][c], exact[0][c], 1e-6 * row_sum);
          EXPECT_NEAR(H[1][c], exact[1][c], 1e-6 * row_sum);
        }
        EXPECT_EQ(H[1][0] == 0, exact[1][0] == 0);
      }
    }
  }
}

/// The inside of a box, of which every other tile is turned out: all tiles are flat, and face any way. The
/// first tile's last element is lifted, so that it alone is not.
std::vector<Element> flat_tiles(bool first_is_flat) {
  std::vector<Element> elements = test_scenes::ClosedBox(8).elements;
  for (std::size_t k = 0; k < elements.size(); ++k)
    if (k / kTileSize % 2 == 1) elements[k].normal = -elements[k].normal;
  if (!first_is_flat) elements[kTileSize - 1].centroid += 0.1f * elements[0].normal;
  return elements;
}

TEST_P(PairKernel, FlatTilesAgreeWithThePlainDoubleLoop) {
  std::mt19937 random(11);
  std::mt19937_64 random_words(12);
  for (const bool first_is_flat : {true, false}) {
    const std::vector<Element> elements = flat_tiles(first_is_flat);
    const PairColumns columns(elements);
    ColumnPower power = random_power(columns, two_sided, kChannels, random);
    for (const std::size_t row : {std::size_t{3}, kTileSize - 1, 2 * kTileSize + 17, 6 * kTileSize - 1}) {
      std::vector<std::uint64_t> words;
      for (std::size_t tile = 0; tile < 6; ++tile)
        words.push_back(tile == row / kTileSize ? 0 : tile % 3 == 0 ? ~std::uint64_t{0} : random_words());
      const auto exact = plain_row(rule, two_sided, elements, columns, power, row, 0, words);
      const auto H = gather_row(rule, two_sided, columns, power, row, 0, words);
      for (std::size_t c = 0; c < kChannels; ++c) {
        const double row_sum = exact[0][c] + exact[1][c];
        EXPECT_GT(row_sum, 0);
        EXPECT_NEAR(H[0][c], exact[0][c], 1e-6 * row_sum);
        EXPECT_NEAR(H[1][c], exact[1][c], 1e-6 * row_sum);
      }
    }
  }
}

TEST_P(PairKernel, EveryBitCountsForItsOwnColumn) {
  std::mt19937 random(3);
  const std::vector<Element> elements = random_elements(2 * kTileSize, 1, random);
  const PairColumns columns(elements);
  ColumnPower power = random_power(columns, two_sided, kChannels, random);
  for (std::size_t c = 0; c < kTileSize; ++c) {
    const std::array<std::uint64_t, 1> word{std::uint64_t{1} << c};
    const auto exact = plain_row(rule, two_sided, elements, columns, power, 5, 1, word);
    const auto H = gather_row(rule, two_sided, columns, power, 5, 1, word);
    EXPECT_NEAR(H[0][1] + H[1][1], exact[0][1] + exact[1][1], 2e-6 * (exact[0][1] + exact[1][1]));
    EXPECT_EQ(H[0][1] > 0, exact[0][1] > 0);
  }
}

TEST_P(PairKernel, NoBitsNoLight) {
  std::mt19937 random(4);
  const std::vector<Element> elements = random_elements(kTileSize, 1, random);
  const PairColumns columns(elements);
  const ColumnPower power = random_power(columns, two_sided, kChannels, random);
  const std::array<std::uint64_t, 1> none{0};
  EXPECT_EQ(gather_row(rule, two_sided, columns, power, 0, 0, none), RowIrradiance<kChannels>{});
}

/// Scattered elements, all of a block's tiles with random bits, and their power.
struct Block {
  std::vector<Element> elements;
  PairColumns columns;
  ColumnPower power;
  std::vector<TileBits> bits{kBlockTiles};
  std::vector<SeenTile> tiles;

  Block(bool two_sided, std::mt19937& random)
      : elements(random_elements(kBlockTiles * kTileSize, 1, random)),
        columns(elements),
        power(random_power(columns, two_sided, kChannels, random)) {
    for (std::size_t t = 0; t < kBlockTiles; ++t) {
      for (std::size_t r = 0; r < kTileSize; ++r)
        bits[t][r] = without(std::uniform_int_distribution<std::uint64_t>()(random), r);
      bits[t][7] = 0;
      tiles.push_back({t, &bits[t]});
    }
  }
};

/// For comparing what may be no number.
auto bytes_of(const RowIrradiance<kChannels>& row) {
  return std::bit_cast<std::array<std::byte, sizeof row>>(row);
}

TEST_P(PairKernel, ARowDependsOnNothingButItself) {
  std::mt19937 random(6);
  Block block(two_sided, random);
  for (std::size_t side = 0; side < (two_sided ? 2u : 1u); ++side)
    block.power.of(2, side, 1)[11] = std::numeric_limits<float>::infinity();
  std::vector<RowIrradiance<kChannels>> all(kTileSize);
  gather_block({rule, two_sided, block.columns, block.power, 0, block.tiles}, all);
  std::size_t reached = 0;
  for (std::size_t first = 0; first < kTileSize; first += 5) {
    std::vector<RowIrradiance<kChannels>> some(std::min<std::size_t>(5, kTileSize - first));
    gather_block({rule, two_sided, block.columns, block.power, first, block.tiles}, some);
    for (std::size_t r = 0; r < some.size(); ++r) {
      ASSERT_EQ(bytes_of(some[r]), bytes_of(all[first + r])) << first + r;
      reached += !std::isfinite(some[r][0][1] + some[r][1][1]);
    }
  }
  EXPECT_GT(reached, 10u);
  EXPECT_EQ(all[7], RowIrradiance<kChannels>{});
}

TEST_P(PairKernel, OneChannelHasTheDigitsOfThree) {
  std::mt19937 random(7);
  Block block(two_sided, random);
  std::vector<RowIrradiance<kChannels>> three(kTileSize);
  gather_block({rule, two_sided, block.columns, block.power, 0, block.tiles}, three);
  for (std::size_t c = 0; c < kChannels; ++c) {
    ColumnPower alone(block.columns.tiles.size(), two_sided ? 2 : 1, 1);
    for (std::size_t tile = 0; tile < block.columns.tiles.size(); ++tile)
      for (std::size_t side = 0; side < (two_sided ? 2u : 1u); ++side)
        alone.of(tile, side, 0) = block.power.of(tile, side, c);
    std::vector<RowIrradiance<1>> one(kTileSize);
    gather_block({rule, two_sided, block.columns, alone, 0, block.tiles}, one);
    for (std::size_t r = 0; r < kTileSize; ++r)
      for (std::size_t side = 0; side < 2; ++side) EXPECT_EQ(one[r][side][0], three[r][side][c]);
  }
}

TEST_P(PairKernel, AgreesWithTheBestInstructionSet) {
  std::mt19937 random(8);
  Block block(two_sided, random);
  std::vector<RowIrradiance<kChannels>> here(kTileSize), best(kTileSize);
  gather_block({rule, two_sided, block.columns, block.power, 0, block.tiles}, here);
  use_instruction_set(Isa::automatic);
  gather_block({rule, two_sided, block.columns, block.power, 0, block.tiles}, best);
  for (std::size_t r = 0; r < kTileSize; ++r)
    for (std::size_t side = 0; side < 2; ++side)
      for (std::size_t c = 0; c < kChannels; ++c)
        EXPECT_NEAR(here[r][side][c], best[r][side][c], 1e-6 * (best[r][0][c] + best[r][1][c]));
}

INSTANTIATE_TEST_SUITE_P(Rules, PairKernel,
                         testing::Combine(testing::Values(PairRule::point, PairRule::disc, PairRule::moments),
                                          testing::Bool(), testing::ValuesIn(supported_instruction_sets())),
                         [](const auto& parameter) {
                           return test_scenes::name_of(std::get<0>(parameter.param)) +
                                  (std::get<1>(parameter.param) ? "TwoSided_" : "OneSided_") +
                                  name_of(std::get<2>(parameter.param));
                         });

// The kernel's matrix is what makes power stay: A_i F_ij and A_j F_ji have the same digits.
TEST(MomentsKernel, IsSymmetric) {
  std::mt19937 random(5);
  std::vector<Element> elements = random_elements(kTileSize, 1, random);
  for (Element& element : elements) element.elongation *= 4;  // so that the second order matters
  const PairColumns columns(elements);
  ColumnPower one(1, 1, 1);
  one.of(0, 0, 0).fill(1);
  std::size_t seen = 0;
  for (std::size_t i = 0; i < kTileSize; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto alone = [](std::size_t k) { return std::array{std::uint64_t{1} << k}; };
      const double there = gather_row<1>(PairRule::moments, false, columns, one, i, 0, alone(j))[0][0];
      const double back = gather_row<1>(PairRule::moments, false, columns, one, j, 0, alone(i))[0][0];
      ASSERT_EQ(there, back) << i << ' ' << j;
      seen += there > 0;
    }
  }
  EXPECT_GT(seen, kTileSize);
}

TEST(MomentsKernel, IsSymmetricBetweenFlatTiles) {
  const std::vector<Element> elements = flat_tiles(true);
  const PairColumns columns(elements);
  ColumnPower one(6, 1, 1);
  for (std::size_t tile = 0; tile < 6; ++tile) one.of(tile, 0, 0).fill(1);
  std::size_t seen = 0;
  for (std::size_t i = 0; i < elements.size(); i += 5) {
    for (std::size_t j = 1; j < elements.size(); j += 7) {
      if (i / kTileSize == j / kTileSize) continue;
      const auto alone = [](std::size_t k) { return std::array{std::uint64_t{1} << k % kTileSize}; };
      const double there =
          gather_row<1>(PairRule::moments, false, columns, one, i, j / kTileSize, alone(j))[0][0];
      const double back =
          gather_row<1>(PairRule::moments, false, columns, one, j, i / kTileSize, alone(i))[0][0];
      ASSERT_EQ(there, back) << i << ' ' << j;
      seen += there > 0;
    }
  }
  EXPECT_GT(seen, 1000u);
}

// Where a row has a million columns, single precision inside a block and double across keep the digits.
TEST(PairKernelOfAMillion, RowsHaveTheDigitsOfSinglePrecision) {
  const test_scenes::ClosedBox box(408);
  const PairColumns columns(box.elements);
  const std::vector<FlatShape> shapes = test_scenes::flat_shapes(box.elements);
  ASSERT_GT(shapes.size(), 990'000u);
  std::mt19937 random(9);
  std::vector<float> x(shapes.size());
  for (float& value : x) value = static_cast<float>(test_scenes::uniform(random, 0, 1));
  const ColumnPower power = test_scenes::power_of(columns, x);
  constexpr int kRows = 64;
  constexpr std::array kRules{PairRule::point, PairRule::moments, PairRule::disc};
  double squares = 0;
  for (std::size_t k = 0; k < kRows; ++k) {
    const std::size_t i = random() % shapes.size();
    const PairRule rule = kRules[k % kRules.size()];
    const double plain = box.plain_row(rule, i, shapes, x);
    const double error = box.kernel_row(rule, i, columns, power) / plain - 1;
    EXPECT_NEAR(plain, 0.5, 0.05) << "the mean of x";
    EXPECT_NEAR(error, 0, 5e-7) << i;
    squares += error * error;
  }
  EXPECT_LT(std::sqrt(squares / kRows), 1e-7);
}

}  // namespace
}  // namespace fluxel
