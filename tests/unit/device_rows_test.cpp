#include "solver/cuda/gather_slice.hpp"

#include <gtest/gtest.h>

#include "solver/channels.hpp"
#include "solver/cuda/host_rows.hpp"
#include "solver/row_device.hpp"
#include "solver/row_operator.hpp"
#include "tests/unit/closed_box.hpp"
#include "tests/unit/known_power.hpp"
#include "tests/unit/test_scenes.hpp"

// The device's code, built for the host, beside the CPU's.
namespace fluxel {
namespace {

using test_scenes::uniform;

/// Elements of a tile stand together, so that some tiles are far from each other.
std::vector<Element> clustered_elements(std::size_t n, std::mt19937& random) {
  std::vector<Element> elements;
  while (elements.size() < n) {
    const glm::vec3 centre(test_scenes::uniform_point(random, -1, 1));
    for (Element& element : test_scenes::random_elements(kTileSize, 0.3, random)) {
      element.centroid += centre;
      elements.push_back(element);
    }
  }
  elements.resize(n);
  return elements;
}

TileTag random_tag(std::mt19937& random) {
  constexpr std::array kTags{TileTag::blocked, TileTag::facing_away, TileTag::visible, TileTag::bits,
                             TileTag::bits};
  return kTags[random() % kTags.size()];
}

TileBits random_bits(std::mt19937& random) {
  TileBits bits;
  for (std::uint64_t& word : bits) {
    word = std::uint64_t{random()} << 32 | random();
    if (random() % 4 == 0) word = 0;
  }
  return bits;
}

/// Of a tile on the diagonal: symmetric, and nothing sees itself.
TileBits symmetric(TileBits bits) {
  for (std::size_t r = 0; r < kTileSize; ++r) bits[r] &= ~std::uint64_t{0} << r << 1;
  TileBits other = bits;
  transpose(other);
  for (std::size_t r = 0; r < kTileSize; ++r) bits[r] |= other[r];
  return bits;
}

/// Tiles of every tag, the same for every owner.
TileStore random_store(std::size_t tiles, TileRows owned) {
  TileStore store(tiles, owned);
  for (std::size_t row = 0; row < tiles; ++row) {
    for (std::size_t column = row; column < tiles; ++column) {
      if (!owned.contains(row) && !owned.contains(column)) continue;
      std::mt19937 random(static_cast<unsigned>(row * tiles + column));
      if (row == column)
        store.put(row, column, TileTag::bits, symmetric(random_bits(random)));
      else
        store.put(row, column, random_tag(random), random_bits(random));
    }
  }
  return store;
}

std::vector<double> random_vector(std::size_t size, std::mt19937& random) {
  std::vector<double> vector(size);
  for (double& value : vector) value = uniform(random, 0, 1);
  return vector;
}

std::vector<Rgb> random_colours(std::size_t size, std::mt19937& random) {
  std::vector<Rgb> vector(size);
  for (Rgb& value : vector) value = test_scenes::uniform_point(random, 0, 1);
  return vector;
}

double largest(std::span<const Rgb> x) {
  double most = 0;
  for (const Rgb& value : x) most = std::max(most, largest_channel(value));
  return most;
}

const Corrections kNone;

/// Sums of one and the other differ by the rounding of single precision: a form factor has a few tens of
/// roundings of 6e-8, up to 128 of them are added to each other before sums go on in double, and the signs
/// are random.
constexpr double kRounding = 1e-6;

void fail(const cuda::DeviceError& error) { FAIL() << error.what(); }

/// A rule, and whether sides are two.
class DeviceRows : public testing::TestWithParam<std::tuple<PairRule, bool>> {
 protected:
  // Several slices of columns, the last one short, and a partly filled last tile.
  static constexpr std::size_t kElements = 14 * kTileSize + 23;

  KernelRule rule{std::get<0>(GetParam()), 0.05};
  bool two_sided = std::get<1>(GetParam());
  std::mt19937 random{3};
  std::vector<Element> elements = clustered_elements(kElements, random);
  PairColumns columns{elements};
  TileStore store = random_store(columns.tiles.size(), {0, columns.tiles.size()});
  std::size_t unknowns = (two_sided ? 2 : 1) * kElements;
  std::vector<Rgb> x = random_colours(unknowns, random);

  [[nodiscard]] cuda::RowMatrix matrix_of(const TileStore& of) const {
    return row_matrix(elements, columns, of, rule, two_sided);
  }
  [[nodiscard]] std::unique_ptr<cuda::RowGatherer> host_rows(const TileStore& of) const {
    return std::make_unique<cuda::HostRows>(matrix_of(of));
  }
  [[nodiscard]] RowOperator make(const TileStore& of, const Corrections& corrections = kNone) const {
    return {elements, columns, of, corrections, rule, two_sided, 2};
  }
  [[nodiscard]] std::vector<Rgb> apply(RowOperator& F) const {
    std::vector<Rgb> H(unknowns, Rgb(-1));
    F.apply(x, H);
    return H;
  }

  void expect_near(std::span<const Rgb> H, std::span<const Rgb> expected) const {
    const double most = largest(expected);
    // There is light; how much depends on the order in which a compiler evaluates arguments that are drawn.
    ASSERT_GT(most, 0.05);
    for (std::size_t k = 0; k < unknowns; ++k)
      for (int c = 0; c < kChannels; ++c) EXPECT_NEAR(H[k][c], expected[k][c], kRounding * most) << k;
  }
};

TEST_P(DeviceRows, TheFixtureHasEveryKindOfTile) {
  const cuda::RowMatrix matrix = matrix_of(store);
  const std::uint32_t tiles = matrix.shape().tiles;
  ASSERT_GT(cuda::slices_of(tiles), 2u);
  ASSERT_NE(tiles % cuda::tiles_of_slice(tiles), 0u);
  ASSERT_NE(kElements % kTileSize, 0u);
  std::array<std::size_t, 3> seen{}, far{};
  for (const cuda::TileEntry entry : matrix.entries()) {
    ++seen[std::min(entry.seen(), cuda::TileEntry::kFirstBits)];
    ++far[entry.is_far()];
  }
  EXPECT_GT(*std::ranges::min_element(seen), 20u);
  EXPECT_GT(far[0], 20u);
  EXPECT_EQ(far[1] > 20, rule.rule == PairRule::moments);
  EXPECT_EQ(matrix.tiles_with_bits(), store.mixed());
}

TEST_P(DeviceRows, AgreeWithTheCpuInThreeChannels) {
  RowDevice device(host_rows(store), fail);
  RowOperator on_cpu = make(store), on_device = make(store);
  on_device.use(device);
  expect_near(apply(on_device), apply(on_cpu));
  EXPECT_GT(device.seconds().kernel, 0);
}

TEST_P(DeviceRows, AgreeWithTheCpuInOneChannel) {
  RowDevice device(host_rows(store), fail);
  RowOperator on_cpu = make(store), on_device = make(store);
  on_device.use(device);
  const std::vector<double> grey = random_vector(unknowns, random);
  std::vector<double> expected(unknowns), H(unknowns, -1);
  on_cpu.apply(grey, expected);
  on_device.apply(grey, H);
  const double most = *std::ranges::max_element(expected);
  ASSERT_GT(most, 0.05);
  for (std::size_t k = 0; k < unknowns; ++k) EXPECT_NEAR(H[k], expected[k], kRounding * most);
  expect_near(apply(on_device), apply(on_cpu));  // three channels again, as solvers change between them
}

TEST_P(DeviceRows, OwnersOfPartsMakeTheBytesOfTheWhole) {
  RowDevice device(host_rows(store), fail);
  RowOperator F = make(store);
  F.use(device);
  const std::vector<Rgb> whole = apply(F);
  std::vector<Rgb> parts(unknowns, Rgb(-1));
  const std::size_t tiles = store.tiles();
  for (const TileRows owned : {TileRows{0, 4}, TileRows{4, 4}, TileRows{4, 5}, TileRows{5, tiles}}) {
    const TileStore own = random_store(tiles, owned);
    RowDevice of_part(host_rows(own), fail);
    RowOperator rows = make(own);
    rows.use(of_part);
    test_scenes::apply_owned_rows(rows, own, elements, x, parts);
  }
  EXPECT_EQ(parts, whole);
}

TEST_P(DeviceRows, WhatSendsNothingIsSkipped) {
  const std::size_t dark = 5;
  ColumnPower power(columns.tiles.size(), two_sided ? 2 : 1, 1);
  std::vector<std::uint8_t> sends(columns.tiles.size(), 1);
  sends[dark] = 0;
  for (std::size_t tile = 0; tile < sends.size(); ++tile)
    for (std::size_t side = 0; side < (two_sided ? 2u : 1u); ++side)
      power.of(tile, side, 0).fill(tile == dark ? std::numeric_limits<float>::quiet_NaN() : 0.0f);
  const auto rows = host_rows(store);
  rows->start(power.of(0), sends.data(), 1);
  const double* sums = rows->gather(0, 3);
  for (std::size_t k = 0; k < 3 * (two_sided ? 2 : 1) * kTileSize; ++k) EXPECT_EQ(sums[k], 0) << k;
}

TEST_P(DeviceRows, CorrectionsAreAdded) {
  Corrections corrections;
  for (std::size_t row = 0; row <= unknowns; ++row) corrections.start.push_back(row);
  for (std::size_t row = 0; row < unknowns; ++row) {
    corrections.column.push_back(static_cast<std::uint32_t>((row * 7) % unknowns));
    corrections.G.push_back(elements[row % kElements].area);
  }
  RowDevice device(host_rows(store), fail);
  RowOperator plain = make(store), corrected = make(store, corrections);
  plain.use(device);
  const std::vector<Rgb> without = apply(plain);
  corrected.use(device);  // one operator after another
  const std::vector<Rgb> with = apply(corrected);
  for (std::size_t row = 0; row < unknowns; ++row)
    for (int c = 0; c < kChannels; ++c)
      EXPECT_NEAR(with[row][c], without[row][c] + x[corrections.column[row]][c], 1e-12 * largest(with));
}

TEST_P(DeviceRows, SweepsStayOnTheCpu) {
  const std::vector<Rgb> E = random_colours(unknowns, random), rho(unknowns, Rgb(0.1));
  std::vector<Rgb> expected = x, swept = x;
  make(store).sweep(E, rho, expected);
  RowDevice device(host_rows(store), fail);
  RowOperator F = make(store);
  F.use(device);
  F.sweep(E, rho, swept);
  EXPECT_EQ(swept, expected);
  EXPECT_EQ(device.seconds().kernel, 0);
}

INSTANTIATE_TEST_SUITE_P(Rules, DeviceRows,
                         testing::Combine(testing::Values(PairRule::point, PairRule::disc, PairRule::moments),
                                          testing::Bool()),
                         [](const auto& parameter) {
                           return test_scenes::name_of(std::get<0>(parameter.param)) +
                                  (std::get<1>(parameter.param) ? "TwoSided" : "OneSided");
                         });

/// Two tile rows of a matrix with long slices, where few columns send: those at the ends of slices and of the
/// 32 tiles that a warp looks at together.
TEST(DeviceRowsOfManyTiles, TakeAllSlicesWhole) {
  constexpr std::size_t kTiles = 2111;
  constexpr auto kSlice = cuda::tiles_of_slice(kTiles);
  static_assert(kSlice == 33);
  std::mt19937 random(4);
  const std::vector<Element> elements = clustered_elements(kTiles * kTileSize - 1, random);
  const PairColumns columns(elements);
  const TileRows owned{40, 42};
  TileStore store(kTiles, owned);
  for (std::size_t row = owned.first; row < owned.last; ++row)
    for (std::size_t column = 0; column < kTiles; ++column)
      if (column != row && !store.has(row, column))
        store.put(std::min(row, column), std::max(row, column), TileTag::visible, TileBits{});
  for (std::size_t row = owned.first; row < owned.last; ++row)
    store.put(row, row, TileTag::blocked, TileBits{});
  std::vector<Rgb> x(elements.size(), Rgb(0)), expected = x, H = x;
  for (const std::size_t tile : {0u, 1u, 31u, 32u, 33u, 64u, 65u, 66u, 98u, 1000u, 2078u, 2079u, 2110u})
    for (std::size_t j = tile * kTileSize; j < std::min(elements.size(), (tile + 1) * kTileSize); ++j)
      x[j] = Rgb(uniform(random, 0, 1));
  RowOperator F(elements, columns, store, kNone, PairRule::disc, false, 1);
  test_scenes::apply_owned_rows(F, store, elements, x, expected);
  RowDevice device(
      std::make_unique<cuda::HostRows>(row_matrix(elements, columns, store, PairRule::disc, false)), fail);
  F.use(device);
  test_scenes::apply_owned_rows(F, store, elements, x, H);
  const double most = largest(expected);
  EXPECT_GT(most, 0);
  for (std::size_t i = owned.first * kTileSize; i < owned.last * kTileSize; ++i)
    EXPECT_NEAR(H[i].r, expected[i].r, kRounding * most) << i;
}

// Single precision inside a tile and double across keep the digits that the bound of the solution's error
// counts on, as on the CPU (PairKernelOfAMillion).
TEST(DeviceRowsOfAClosedBox, HaveTheDigitsOfSinglePrecision) {
  const test_scenes::ClosedBox box(56);
  const PairColumns columns(box.elements);
  const std::vector<FlatShape> shapes = test_scenes::flat_shapes(box.elements);
  std::mt19937 random(6);
  std::vector<float> x(shapes.size());
  for (float& value : x) value = static_cast<float>(uniform(random, 0, 1));
  ColumnPower power = test_scenes::power_of(columns, x);
  const std::vector<std::uint8_t> sends(columns.tiles.size(), 1);
  const auto summary_of = [&](std::uint32_t row, std::uint32_t column) {
    const bool faces = box.face_of(row * kTileSize) != box.face_of(column * kTileSize);
    return cuda::TileSummary{faces ? cuda::TileSummary::Seen::all : cuda::TileSummary::Seen::nothing, false};
  };
  double squares = 0;
  std::size_t rows = 0;
  for (const PairRule rule : {PairRule::point, PairRule::disc, PairRule::moments}) {
    const auto tile_row = static_cast<std::uint32_t>(random() % columns.tiles.size());
    const cuda::RowShape shape{static_cast<cuda::Rule>(rule), false,
                               static_cast<std::uint32_t>(columns.tiles.size()), tile_row, tile_row + 1};
    cuda::HostRows host(
        cuda::RowMatrix(shape, reinterpret_cast<const float*>(columns.tiles.data()), summary_of, nullptr));
    host.start(power.of(0), sends.data(), 1);
    const double* sums = host.gather(tile_row, tile_row + 1);
    for (std::size_t r = 0; r < kTileSize; ++r, ++rows) {
      const double plain = box.plain_row(rule, tile_row * kTileSize + r, shapes, x);
      const double error = sums[r] / plain - 1;
      EXPECT_GT(plain, 0.3) << "the mean of x is 0.5";
      EXPECT_NEAR(error, 0, 5e-7) << r;
      squares += error * error;
    }
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(rows)), 1e-7);
}

}  // namespace
}  // namespace fluxel
