#include "solver/row_operator.hpp"

#include <gtest/gtest.h>

#include "formfactor/pair_rule.hpp"
#include "tests/unit/known_power.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using test_scenes::apply_owned_rows;
using test_scenes::KnownPower;
using test_scenes::random_plates;
using test_scenes::traced;
using test_scenes::uniform;
using test_scenes::uniform_elements;
using test_scenes::unknowns_of;

/// Plates with more than one block of tiles and a partly filled last one, their visibility, and random
/// vectors.
struct RowSystem {
  Scene scene;
  std::vector<Element> elements;
  RayScene ray_scene;
  TileStore store;
  bool two_sided;
  std::vector<Rgb> x;

  explicit RowSystem(Sides sides)
      : scene(random_plates(59, 0.7, sides, 1)),
        elements(uniform_elements(scene, 0.2).elements),
        ray_scene(scene, 3),  // its limit on threads is the whole program's
        store(traced(ray_scene, elements)),
        two_sided(sides == Sides::two),
        x(random_vector(2)) {}

  [[nodiscard]] std::size_t unknowns() const { return elements.size() * (two_sided ? 2 : 1); }

  [[nodiscard]] std::vector<Rgb> random_vector(unsigned seed) const {
    std::mt19937 random(seed);
    std::vector<Rgb> vector(unknowns());
    for (Rgb& value : vector) value = test_scenes::uniform_point(random, 0, 1);
    return vector;
  }

  [[nodiscard]] bool sees(std::size_t i, std::size_t j) const {
    TileBits bits;
    store.read(i / kTileSize, j / kTileSize, bits);
    return (bits[i % kTileSize] >> (j % kTileSize) & 1u) != 0;
  }

  /// The unknown that side of `of` which looks at `at` is.
  [[nodiscard]] std::size_t facing_unknown(std::size_t of, std::size_t at) const {
    const glm::vec3 separation = elements[at].centroid - elements[of].centroid;
    return two_sided && glm::dot(elements[of].normal, separation) < 0 ? elements.size() + of : of;
  }

  /// Row i of F times `values`, added to the entries of its front and back in `H`.
  void add_plain_row(PairRule rule, std::size_t i, std::span<const Rgb> values, std::span<Rgb> H) const {
    TileBits bits;
    for (std::size_t j = 0; j < elements.size(); ++j) {
      if (j % kTileSize == 0) store.read(i / kTileSize, j / kTileSize, bits);
      if ((bits[i % kTileSize] >> (j % kTileSize) & 1u) == 0) continue;
      H[facing_unknown(i, j)] +=
          pair_form_factor(rule, elements[i], elements[j]) * values[facing_unknown(j, i)];
    }
  }
};

const Corrections kNone;

class RowOperators : public testing::TestWithParam<std::tuple<PairRule, Sides>> {
 protected:
  PairRule rule = std::get<0>(GetParam());
  RowSystem system{std::get<1>(GetParam())};

  [[nodiscard]] RowOperator make(const TileStore& store, int threads = 1,
                                 const Corrections& corrections = kNone) const {
    return {system.elements, store, corrections, rule, system.two_sided, threads};
  }
};

TEST_P(RowOperators, AgreesWithThePlainDoubleLoop) {
  ASSERT_GT(system.store.tiles(), kBlockTiles);
  ASSERT_NE(system.elements.size() % kTileSize, 0u);
  std::vector<Rgb> plain(system.unknowns(), Rgb(0)), H(system.unknowns(), Rgb(-1));
  for (std::size_t i = 0; i < system.elements.size(); ++i) system.add_plain_row(rule, i, system.x, plain);
  make(system.store).apply(system.x, H);
  // Grazing pairs lose digits in single precision, but they are small in the sum of both sides.
  const std::size_t n = system.elements.size();
  double largest = 0;
  for (std::size_t k = 0; k < H.size(); ++k) {
    for (int channel = 0; channel < kChannels; ++channel) {
      const double row_sum = plain[k % n][channel] + (system.two_sided ? plain[k % n + n][channel] : 0);
      EXPECT_NEAR(H[k][channel], plain[k][channel], 2e-6 * row_sum);
      largest = std::max(largest, row_sum);
    }
  }
  EXPECT_GT(largest, 0.1);
}

TEST_P(RowOperators, ASweepTakesTheNewestValues) {
  const std::vector<Rgb> E = system.random_vector(5), rho = system.random_vector(6);
  std::vector<Rgb> plain = system.x, swept = system.x;
  std::vector<Rgb> H(system.unknowns());
  for (std::size_t i = 0; i < system.elements.size(); ++i) {
    H[i] = Rgb(0);
    if (system.two_sided) H[system.elements.size() + i] = Rgb(0);
    system.add_plain_row(rule, i, plain, H);
    for (std::size_t k = i; k < plain.size(); k += system.elements.size()) plain[k] = E[k] + rho[k] * H[k];
  }
  make(system.store).sweep(E, rho, swept);
  for (std::size_t i = 0; i < plain.size(); ++i)
    for (int channel = 0; channel < kChannels; ++channel)
      EXPECT_NEAR(swept[i][channel], plain[i][channel], 2e-6);  // of values about 1
}

/// Random corrections of the rows that `owned` has, and none elsewhere.
Corrections random_corrections(const RowSystem& system, const TileRows& owned) {
  Corrections corrections;
  corrections.start.push_back(0);
  for (std::size_t row = 0; row < system.unknowns(); ++row) {
    const std::size_t i = row % system.elements.size();
    std::mt19937 random(static_cast<unsigned>(row));  // the same for every owner
    for (std::size_t column = random() % 50; column < system.unknowns() && row % 3 != 0;
         column += 1 + random() % 90) {
      if (!owned.contains(i / kTileSize)) break;
      corrections.column.push_back(static_cast<std::uint32_t>(column));
      corrections.G.push_back(system.elements[i].area * static_cast<float>(uniform(random, -0.01, 0.02)));
    }
    corrections.start.push_back(corrections.column.size());
  }
  return corrections;
}

TEST_P(RowOperators, CorrectionsAreAdded) {
  const Corrections corrections = random_corrections(system, {0, system.store.tiles()});
  std::vector<Rgb> plain(system.unknowns()), H(system.unknowns());
  make(system.store).apply(system.x, plain);
  make(system.store, 2, corrections).apply(system.x, H);
  double largest = 0;
  for (std::size_t row = 0; row < system.unknowns(); ++row) {
    Rgb added(0);
    const auto area = static_cast<double>(system.elements[row % system.elements.size()].area);
    for (std::size_t k = corrections.start[row]; k < corrections.start[row + 1]; ++k)
      added += static_cast<double>(corrections.G[k]) / area * system.x[corrections.column[k]];
    for (int c = 0; c < kChannels; ++c) EXPECT_NEAR(H[row][c], plain[row][c] + added[c], 1e-14);
    largest = std::max(largest, std::abs(added.r));
  }
  EXPECT_GT(largest, 0.01);
}

TEST_P(RowOperators, ASweepCorrectsWithTheNewestValues) {
  const Corrections corrections = random_corrections(system, {0, system.store.tiles()});
  const std::vector<Rgb> E = system.random_vector(5), rho = system.random_vector(6);
  const std::size_t n = system.elements.size();
  std::vector<Rgb> plain = system.x, swept = system.x;
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<Rgb> H(system.unknowns(), Rgb(0));
    system.add_plain_row(rule, i, plain, H);
    for (std::size_t row = i; row < plain.size(); row += n) {
      for (std::size_t k = corrections.start[row]; k < corrections.start[row + 1]; ++k)
        H[row] += static_cast<double>(corrections.G[k]) / static_cast<double>(system.elements[i].area) *
                  plain[corrections.column[k]];
      plain[row] = E[row] + rho[row] * H[row];
    }
  }
  make(system.store, 2, corrections).sweep(E, rho, swept);
  for (std::size_t row = 0; row < plain.size(); ++row)
    for (int c = 0; c < kChannels; ++c) EXPECT_NEAR(swept[row][c], plain[row][c], 3e-6);
}

TEST_P(RowOperators, OwnersOfPartsCorrectTheirOwn) {
  const std::size_t tiles = system.store.tiles();
  const Corrections all = random_corrections(system, {0, tiles});
  std::vector<Rgb> whole(system.unknowns()), parts(system.unknowns(), Rgb(-1));
  make(system.store, 1, all).apply(system.x, whole);
  for (const TileRows owned : {TileRows{0, 2}, TileRows{2, tiles}}) {
    const TileStore store = traced(system.ray_scene, system.elements, owned);
    const Corrections own = random_corrections(system, owned);
    RowOperator F = make(store, 2, own);
    apply_owned_rows(F, store, system.elements, system.x, parts);
  }
  EXPECT_EQ(parts, whole);
}

TEST_P(RowOperators, ThreadsDoNotChangeAByte) {
  std::vector<Rgb> one(system.unknowns()), swept_by_one = system.x;
  make(system.store, 1).apply(system.x, one);
  make(system.store, 1).sweep(one, system.random_vector(6), swept_by_one);
  for (const int threads : {2, 3}) {
    std::vector<Rgb> more(system.unknowns()), swept = system.x;
    RowOperator F = make(system.store, threads);
    F.apply(system.x, more);
    EXPECT_EQ(more, one);
    F.sweep(one, system.random_vector(6), swept);
    EXPECT_EQ(swept, swept_by_one);
  }
}

TEST_P(RowOperators, OwnersOfPartsMakeTheBytesOfTheWhole) {
  std::vector<Rgb> whole(system.unknowns()), parts(system.unknowns(), Rgb(-1));
  make(system.store).apply(system.x, whole);
  const std::size_t tiles = system.store.tiles();
  for (const TileRows owned :
       {TileRows{0, 1}, TileRows{1, 1}, TileRows{1, tiles - 2}, TileRows{tiles - 2, tiles}}) {
    const TileStore store = traced(system.ray_scene, system.elements, owned);
    RowOperator F = make(store);
    apply_owned_rows(F, store, system.elements, system.x, parts);
  }
  EXPECT_EQ(parts, whole);
}

// What other rows send stays what it was when the sweep began.
TEST_P(RowOperators, ASweepOfAPartTakesTheOldValuesOfTheOthers) {
  const std::vector<Rgb> E = system.random_vector(5), rho = system.random_vector(6);
  const std::size_t n = system.elements.size(), tiles = system.store.tiles();
  const TileRows owned{2, tiles - 1};
  const TileStore store = traced(system.ray_scene, system.elements, owned);
  RowOperator F = make(store);
  KnownPower power(system.elements, owned, system.x);
  F.use(power);
  const std::vector<std::size_t> own = unknowns_of(owned, n, system.unknowns());
  std::vector<Rgb> own_E, own_rho, swept;
  for (const std::size_t k : own) {
    own_E.push_back(E[k]);
    own_rho.push_back(rho[k]);
    swept.push_back(system.x[k]);
  }
  F.sweep(own_E, own_rho, swept);
  std::vector<Rgb> plain = system.x, H(system.unknowns());
  for (std::size_t i = owned.first * kTileSize; i < owned.last * kTileSize; ++i) {
    H[i] = Rgb(0);
    if (system.two_sided) H[n + i] = Rgb(0);
    system.add_plain_row(rule, i, plain, H);
    for (std::size_t k = i; k < plain.size(); k += n) plain[k] = E[k] + rho[k] * H[k];
  }
  for (std::size_t k = 0; k < own.size(); ++k)
    for (int c = 0; c < kChannels; ++c) EXPECT_NEAR(swept[k][c], plain[own[k]][c], 2e-6);
}

TEST_P(RowOperators, ExchangeIsReciprocal) {
  const std::vector<Rgb> y = system.random_vector(3);
  std::vector<Rgb> Fx(system.unknowns()), Fy(system.unknowns());
  RowOperator F = make(system.store);
  F.apply(system.x, Fx);
  F.apply(y, Fy);
  Rgb there(0), back(0);
  for (std::size_t k = 0; k < y.size(); ++k) {
    const auto area = static_cast<double>(system.elements[k % system.elements.size()].area);
    there += area * system.x[k] * Fy[k];
    back += area * y[k] * Fx[k];
  }
  for (int channel = 0; channel < kChannels; ++channel)
    EXPECT_NEAR(there[channel], back[channel], 1e-6 * there[channel]);
}

TEST_P(RowOperators, ScalingByPowersOfTwoChangesNoByte) {
  std::vector<Rgb> unscaled(system.unknowns());
  make(system.store).apply(system.x, unscaled);
  for (const float scale : {0x1p-20f, 0x1p-3f, 0x1p20f}) {
    std::vector<Element> elements = system.elements;
    for (Element& element : elements) {
      element.centroid *= scale;
      element.area *= scale * scale;
      element.minor_variance *= scale * scale;
      element.elongation *= scale;
    }
    std::vector<Rgb> scaled(system.unknowns());
    RowOperator(elements, system.store, kNone, rule, system.two_sided, 1).apply(system.x, scaled);
    EXPECT_EQ(scaled, unscaled) << scale;
  }
}

// Radiosity may have any magnitude: nothing overflows or underflows on the way, and powers of two change no
// digit. (-996 and 996: about 1e-300 and 1e300.)
TEST_P(RowOperators, TinyAndHugeValuesKeepTheirDigits) {
  std::vector<Rgb> unscaled(system.unknowns()), scaled(system.unknowns()), x(system.unknowns());
  const Corrections corrections = random_corrections(system, {0, system.store.tiles()});
  RowOperator F = make(system.store, 2, corrections);
  F.apply(system.x, unscaled);
  for (const int exponent : {-996, -200, 200, 996}) {
    for (std::size_t k = 0; k < x.size(); ++k)
      for (int c = 0; c < kChannels; ++c) x[k][c] = std::ldexp(system.x[k][c], exponent);
    F.apply(x, scaled);
    std::size_t differing = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
      for (int c = 0; c < kChannels; ++c) {
        ASSERT_TRUE(std::isfinite(scaled[k][c])) << exponent;
        if (scaled[k][c] != std::ldexp(unscaled[k][c], exponent)) ++differing;
      }
    }
    EXPECT_EQ(differing, 0u) << exponent;
  }
}

TEST_P(RowOperators, NothingSentIsNothingReceived) {
  std::vector<Rgb> zero(system.unknowns(), Rgb(0)), H(system.unknowns(), Rgb(-1));
  make(system.store).apply(zero, H);
  EXPECT_EQ(H, zero);
}

/// One channel of a vector.
std::vector<double> channel_of(std::span<const Rgb> values, int channel) {
  std::vector<double> alone;
  for (const Rgb& value : values) alone.push_back(value[channel]);
  return alone;
}

TEST_P(RowOperators, OneChannelHasTheDigitsOfThree) {
  const Corrections corrections = random_corrections(system, {0, system.store.tiles()});
  const std::vector<Rgb> E = system.random_vector(5), rho = system.random_vector(6);
  for (Rgb& value : system.x) value.g *= 1e-9;  // a channel alone is measured in another unit
  std::vector<Rgb> H(system.unknowns()), swept = system.x;
  RowOperator F = make(system.store, 2, corrections);
  F.apply(system.x, H);
  F.sweep(E, rho, swept);
  for (int c = 0; c < kChannels; ++c) {
    const std::vector<double> x = channel_of(system.x, c);
    std::vector<double> H_alone(x.size()), swept_alone = x;
    F.apply(x, H_alone);
    F.sweep(channel_of(E, c), channel_of(rho, c), swept_alone);
    EXPECT_EQ(H_alone, channel_of(H, c));
    EXPECT_EQ(swept_alone, channel_of(swept, c));
  }
}

// A store that lacks all tiles but those of one column throws when another is asked for.
TEST_P(RowOperators, ColumnsWithoutPowerAreNotAskedFor) {
  const std::size_t tiles = system.store.tiles(), lit = 9, n = system.elements.size();
  TileStore column(tiles, {0, tiles});
  for (std::size_t tile = 0; tile < tiles; ++tile) {
    TileBits bits;
    system.store.read(std::min(tile, lit), std::max(tile, lit), bits);
    column.put(std::min(tile, lit), std::max(tile, lit), system.store.tag(tile, lit), bits);
  }
  for (const bool lit_front : {true, false}) {
    std::vector<Rgb> x(system.unknowns(), Rgb(0.0, -0.0, 0.0)), plain(system.unknowns(), Rgb(0));
    const std::size_t side = lit_front || !system.two_sided ? 0 : n;
    for (std::size_t j = lit * kTileSize; j < (lit + 1) * kTileSize; ++j) x[side + j].b = system.x[j].b;
    for (std::size_t i = 0; i < n; ++i) system.add_plain_row(rule, i, x, plain);
    std::vector<Rgb> H(system.unknowns()), whole(system.unknowns());
    make(column).apply(x, H);
    make(system.store).apply(x, whole);
    EXPECT_EQ(H, whole);
    double largest = 0;
    for (std::size_t k = 0; k < H.size(); ++k) {
      // Rows that see nothing but grazing columns have few digits.
      EXPECT_NEAR(H[k].b, plain[k].b, 1e-9 + 2e-6 * plain[k].b);
      EXPECT_EQ(H[k].r, 0);
      largest = std::max(largest, H[k].b);
    }
    EXPECT_GT(largest, 1e-3);
  }
}

TEST_P(RowOperators, WhatIsNoNumberReachesThoseWhoSeeIt) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double wrong : {kInfinity, -kInfinity, std::numeric_limits<double>::quiet_NaN()}) {
    std::vector<Rgb> x(system.unknowns(), Rgb(0)), H(system.unknowns());
    const std::size_t j = 9 * kTileSize + 5, n = system.elements.size();
    x[j].g = wrong;
    if (system.two_sided) x[n + j].g = wrong;
    make(system.store).apply(x, H);
    std::size_t seen = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (!system.sees(i, j)) continue;
      EXPECT_FALSE(std::isfinite(H[i].g + H[H.size() - n + i].g)) << wrong;
      ++seen;
    }
    EXPECT_GT(seen, 10u);
  }
}

INSTANTIATE_TEST_SUITE_P(Rules, RowOperators,
                         testing::Combine(testing::Values(PairRule::point, PairRule::disc, PairRule::moments),
                                          testing::Values(Sides::one, Sides::two)),
                         [](const auto& parameter) {
                           return test_scenes::name_of(std::get<0>(parameter.param)) +
                                  (std::get<1>(parameter.param) == Sides::two ? "TwoSided" : "OneSided");
                         });

}  // namespace
}  // namespace fluxel
