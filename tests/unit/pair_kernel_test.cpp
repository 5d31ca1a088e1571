#include "solver/pair_kernel.hpp"

#include <gtest/gtest.h>

#include "formfactor/pair_rule.hpp"
#include "tests/unit/test_scenes.hpp"
#include "visibility/tile.hpp"

namespace fluxel {
namespace {

/// Elements of any direction and elongation scattered in a cube.
std::vector<Element> random_elements(std::size_t n, double reach, std::mt19937& random) {
  std::vector<Element> elements(n);
  for (Element& element : elements) {
    element.centroid = glm::vec3(test_scenes::uniform_point(random, -reach, reach));
    element.normal = glm::vec3(test_scenes::random_direction(random));
    element.area = static_cast<float>(reach * reach * test_scenes::uniform(random, 1e-4, 1e-2));
    element.sides = kFront | kBack;
    const glm::vec3 along =
        glm::normalize(glm::cross(element.normal, glm::vec3(test_scenes::random_direction(random))));
    element.spread = element.area * static_cast<float>(test_scenes::uniform(random, 0.02, 0.1));
    element.elongation =
        along * std::sqrt(element.area * static_cast<float>(test_scenes::uniform(random, 0, 0.5)));
  }
  return elements;
}

ColumnPower random_power(const PairColumns& columns, std::size_t n, bool two_sided, std::mt19937& random) {
  ColumnPower power;
  for (std::size_t side = 0; side < (two_sided ? 2u : 1u); ++side) {
    for (std::vector<float>& channel : power.of[side]) {
      channel.assign(columns.padded(), 0);
      for (std::size_t j = 0; j < n; ++j)
        channel[j] = columns.area[j] * static_cast<float>(test_scenes::uniform(random, 0, 1));
    }
  }
  return power;
}

/// The plain double loop, over the elements and powers as they are.
RowIrradiance plain_row(PairRule rule, bool two_sided, std::span<const Element> elements,
                        const PairColumns& columns, const ColumnPower& power, std::size_t i,
                        std::size_t first_tile, std::span<const std::uint64_t> words) {
  RowIrradiance sum;
  for (std::size_t t = 0; t < words.size(); ++t) {
    for (std::size_t c = 0; c < kTileSize; ++c) {
      if ((words[t] >> c & 1u) == 0) continue;
      const std::size_t j = (first_tile + t) * kTileSize + c;
      const glm::vec3 separation = elements[j].centroid - elements[i].centroid;
      const bool front_of_i = !two_sided || glm::dot(elements[i].normal, separation) > 0;
      const std::size_t side_of_j = !two_sided || glm::dot(elements[j].normal, separation) < 0 ? 0 : 1;
      const double F = pair_form_factor(rule, elements[i], elements[j]);
      for (std::size_t channel = 0; channel < kChannels; ++channel)
        (front_of_i ? sum.front : sum.back)[static_cast<int>(channel)] +=
            F * static_cast<double>(power.of[side_of_j][channel][j]) / static_cast<double>(columns.area[j]);
    }
  }
  return sum;
}

class PairKernel : public testing::TestWithParam<std::tuple<PairRule, bool>> {};

TEST_P(PairKernel, AgreesWithThePlainDoubleLoop) {
  const auto [rule, two_sided] = GetParam();
  std::mt19937 random(1);
  std::mt19937_64 random_words(2);
  for (const double reach : {1e-3, 1.0, 700.0}) {
    const std::size_t n = 3 * kTileSize + 17;
    const std::vector<Element> elements = random_elements(n, reach, random);
    const PairColumns columns(elements);
    const ColumnPower power = random_power(columns, n, two_sided, random);
    for (const std::size_t row : {std::size_t{0}, std::size_t{70}, n - 1}) {
      for (std::size_t first = 0; first < 4; ++first) {
        std::vector<std::uint64_t> words;
        for (std::size_t tile = first; tile < 4; ++tile)
          words.push_back(random_words() & low_bits(rows_of_tile(tile, n)));
        if (row / kTileSize >= first)
          words[row / kTileSize - first] &= ~(std::uint64_t{1} << row % kTileSize);
        const RowIrradiance exact = plain_row(rule, two_sided, elements, columns, power, row, first, words);
        const RowIrradiance H = gather_row(rule, two_sided, columns, power, row, first, words);
        for (int channel = 0; channel < kChannels; ++channel) {
          // Grazing pairs lose digits in single precision, but they are small in the row.
          const double row_sum = exact.front[channel] + exact.back[channel];
          EXPECT_NEAR(H.front[channel], exact.front[channel], 2e-6 * row_sum);
          EXPECT_NEAR(H.back[channel], exact.back[channel], 2e-6 * row_sum);
        }
        EXPECT_EQ(H.back == Rgb(0), exact.back == Rgb(0));
      }
    }
  }
}

TEST_P(PairKernel, EveryBitCountsForItsOwnColumn) {
  const auto [rule, two_sided] = GetParam();
  std::mt19937 random(3);
  const std::vector<Element> elements = random_elements(2 * kTileSize, 1, random);
  const PairColumns columns(elements);
  const ColumnPower power = random_power(columns, elements.size(), two_sided, random);
  for (std::size_t c = 0; c < kTileSize; ++c) {
    const std::array<std::uint64_t, 1> word{std::uint64_t{1} << c};
    const RowIrradiance exact = plain_row(rule, two_sided, elements, columns, power, 5, 1, word);
    const RowIrradiance H = gather_row(rule, two_sided, columns, power, 5, 1, word);
    EXPECT_NEAR(H.front.g + H.back.g, exact.front.g + exact.back.g, 2e-6 * (exact.front.g + exact.back.g));
    EXPECT_EQ(H.front.g > 0, exact.front.g > 0);
  }
}

TEST_P(PairKernel, NoBitsNoLight) {
  const auto [rule, two_sided] = GetParam();
  std::mt19937 random(4);
  const std::vector<Element> elements = random_elements(kTileSize, 1, random);
  const PairColumns columns(elements);
  const ColumnPower power = random_power(columns, elements.size(), two_sided, random);
  const std::array<std::uint64_t, 1> none{0};
  const RowIrradiance H = gather_row(rule, two_sided, columns, power, 0, 0, none);
  EXPECT_EQ(H.front, Rgb(0));
  EXPECT_EQ(H.back, Rgb(0));
}

INSTANTIATE_TEST_SUITE_P(
    Rules, PairKernel,
    testing::Combine(testing::Values(PairRule::point, PairRule::disc, PairRule::moments), testing::Bool()),
    [](const auto& parameter) {
      const PairRule rule = std::get<0>(parameter.param);
      const char* name = rule == PairRule::point ? "point" : rule == PairRule::disc ? "disc" : "moments";
      return std::string(name) + (std::get<1>(parameter.param) ? "TwoSided" : "OneSided");
    });

// The kernel's matrix is what makes power stay: A_i F_ij and A_j F_ji differ by the last digits.
TEST(MomentsKernel, IsSymmetricToRounding) {
  std::mt19937 random(5);
  const std::vector<Element> elements = random_elements(kTileSize, 1, random);
  const PairColumns columns(elements);
  ColumnPower one;
  for (std::vector<float>& channel : one.of[0]) channel.assign(columns.padded(), 1);
  for (std::size_t i = 0; i < kTileSize; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto alone = [](std::size_t k) { return std::array{std::uint64_t{1} << k}; };
      const Rgb there = gather_row(PairRule::moments, false, columns, one, i, 0, alone(j)).front;
      const Rgb back = gather_row(PairRule::moments, false, columns, one, j, 0, alone(i)).front;
      ASSERT_NEAR(there.r, back.r, 4e-6 * there.r) << i << ' ' << j;
    }
  }
}

TEST(PairKernelTarget, IsNamed) { EXPECT_FALSE(pair_kernel_target().empty()); }

}  // namespace
}  // namespace fluxel
