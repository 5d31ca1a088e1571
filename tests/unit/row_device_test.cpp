#include "solver/row_device.hpp"

#include <gtest/gtest.h>

#include "solver/cuda/check_rows.hpp"
#include "solver/cuda/device_rows.hpp"
#include "solver/cuda/host_rows.hpp"
#include "solver/row_operator.hpp"
#include "tests/unit/test_scenes.hpp"

// What becomes of devices that fail, and what the check of a device finds.
namespace fluxel {
namespace {

/// Gathers like another until it has been called so many times, then fails.
class FailingRows final : public cuda::RowGatherer {
 public:
  FailingRows(std::unique_ptr<cuda::RowGatherer> rows, int calls) : rows_(std::move(rows)), calls_(calls) {}

  void start(const float* power, const std::uint8_t* sends, std::uint32_t channels) override {
    call();
    rows_->start(power, sends, channels);
  }
  const double* gather(std::uint32_t first, std::uint32_t last) override {
    call();
    return rows_->gather(first, last);
  }
  [[nodiscard]] cuda::DeviceSeconds seconds() const override { return {1, 2}; }

 private:
  void call() {
    if (calls_-- == 0) throw cuda::DeviceError("the GPU could not gather rows: out of order");
  }
  std::unique_ptr<cuda::RowGatherer> rows_;
  int calls_;
};

class FailingDevice : public testing::Test {
 protected:
  static constexpr std::size_t kTiles = 5;
  std::mt19937 random{8};
  std::vector<Element> elements = test_scenes::random_elements(kTiles * kTileSize - 3, 1, random);
  PairColumns columns{elements};
  TileStore store{kTiles, {0, kTiles}};
  Corrections none;
  RowOperator on_cpu{elements, columns, store, none, PairRule::disc, false, 1};
  RowOperator on_device{elements, columns, store, none, PairRule::disc, false, 1};
  std::vector<Rgb> x, expected, H;
  std::vector<std::string> told;

  void SetUp() override {
    TileBits all;
    all.fill(~std::uint64_t{0});
    for (std::size_t row = 0; row < kTiles; ++row)
      for (std::size_t column = row; column < kTiles; ++column)
        store.put(row, column,
                  column == row ? TileTag::blocked
                  : column == 4 ? TileTag::bits
                                : TileTag::visible,
                  all);
    for (std::size_t i = 0; i < elements.size(); ++i) x.push_back(test_scenes::uniform_point(random, 0, 1));
    H.assign(x.size(), Rgb(-1));
    expected = H;
    on_cpu.apply(x, expected);
  }

  [[nodiscard]] RowDevice failing_after(int calls, RowDevice::WhenItFails when_it_fails) const {
    const cuda::RowMatrix matrix = row_matrix(elements, columns, store, PairRule::disc, false);
    return {std::make_unique<FailingRows>(std::make_unique<cuda::HostRows>(matrix), calls),
            std::move(when_it_fails)};
  }
};

TEST_F(FailingDevice, TheCpuGoesOnInTheMidstOfAProduct) {
  RowDevice device =
      failing_after(3, [&](const cuda::DeviceError& error) { told.emplace_back(error.what()); });
  on_device.use(device);
  on_device.apply(x, H);
  EXPECT_TRUE(device.works());
  for (std::size_t i = 0; i < H.size(); ++i) {
    EXPECT_NE(H[i], expected[i]) << "by the device, whose sums are rounded elsewhere";
    for (int c = 0; c < kChannels; ++c) EXPECT_NEAR(H[i][c], expected[i][c], 1e-6 * expected[i][c]);
  }
  on_device.apply(x, H);
  EXPECT_FALSE(device.works()) << "it has started, and does not gather";
  EXPECT_EQ(H, expected) << "by the CPU";
  EXPECT_EQ(told, std::vector<std::string>{"the GPU could not gather rows: out of order"}) << "once";
  EXPECT_EQ(device.seconds().transfer, 2) << "until it failed";
}

TEST_F(FailingDevice, TheCpuStartsWhereItCouldNotEvenStart) {
  RowDevice device =
      failing_after(0, [&](const cuda::DeviceError& error) { told.emplace_back(error.what()); });
  on_device.use(device);
  on_device.apply(x, H);
  EXPECT_EQ(H, expected);
  EXPECT_EQ(told.size(), 1u);
}

TEST_F(FailingDevice, WhoInsistsOnItIsToldAndLosesNothing) {
  RowDevice device = failing_after(1, [](const cuda::DeviceError& error) { throw error; });
  on_device.use(device);
  EXPECT_THROW(on_device.apply(x, H), cuda::DeviceError);
  EXPECT_EQ(H, std::vector<Rgb>(x.size(), Rgb(-1))) << "left as it was";
  on_device.apply(x, H);
  EXPECT_EQ(H, expected) << "by the CPU";
}

TEST_F(FailingDevice, MemoryIsRefusedBeforeItIsAskedFor) {
  const cuda::RowMatrix matrix = row_matrix(elements, columns, store, PairRule::disc, false);
  const std::size_t needed = cuda::device_bytes(matrix);
  constexpr std::size_t kNumbers = 3 * kTileSize, kSlices = 2, kTilesWithBits = 4;
  EXPECT_EQ(needed, kTiles * 13 * kTileSize * sizeof(float)                     // columns
                        + kTiles * kTiles * sizeof(std::uint32_t)               // entries
                        + kTilesWithBits * sizeof(TileBits)                     //
                        + kTiles * (kNumbers * sizeof(float) + 1)               // power, and what sends
                        + kTiles * kNumbers * (1 + kSlices) * sizeof(double));  // sums, of slices and of all
  EXPECT_NO_THROW(cuda::require_room(matrix, needed));
  try {
    cuda::require_room(matrix, needed - 1);
    FAIL();
  } catch (const cuda::DeviceError& error) {
    EXPECT_NE(std::string(error.what()).find("and this rank may use"), std::string::npos) << error.what();
  }
}

TEST_F(FailingDevice, ADeviceThatIsNotThereIsSaid) {
  std::string why;
  if (!cuda::find_devices(why).empty()) GTEST_SKIP() << "there is one";
  try {
    static_cast<void>(
        make_device_rows(row_matrix(elements, columns, store, PairRule::disc, false), 0, 1u << 30));
    FAIL();
  } catch (const cuda::DeviceError& error) {
    EXPECT_GT(std::string(error.what()).size(), 20u);
  }
}

constexpr cuda::RowCheckCase kCase{15 * kTileSize - 9, cuda::Rule::moments, true, 3};

std::unique_ptr<cuda::RowGatherer> host_rows(const cuda::RowMatrix& matrix) {
  return std::make_unique<cuda::HostRows>(matrix);
}

TEST(CheckOfRows, FindsTheHostBuildLikeItself) {
  for (const cuda::Rule rule : {cuda::Rule::point, cuda::Rule::disc, cuda::Rule::moments}) {
    cuda::RowCheckCase of = kCase;
    of.rule = rule;
    const cuda::RowCheck check = cuda::check_rows(of, host_rows);
    EXPECT_EQ(check.largest_difference, 0);
    EXPECT_TRUE(check.repeats);
    EXPECT_EQ(check.pairs, 951.0 * 951.0);
    EXPECT_LT(check.gathered_pairs, 0.9 * check.pairs);
    EXPECT_GT(check.gathered_pairs, 0.5 * check.pairs);
    EXPECT_GT(check.kernel_seconds, 0);
    EXPECT_EQ(check.compared_tile_rows, 12u);
  }
}

/// Changes one of the sums, at every call or at the second.
class WrongRows final : public cuda::RowGatherer {
 public:
  WrongRows(const cuda::RowMatrix& matrix, double added, bool always)
      : rows_(matrix), added_(added), always_(always) {}

  void start(const float* power, const std::uint8_t* sends, std::uint32_t channels) override {
    rows_.start(power, sends, channels);
  }
  const double* gather(std::uint32_t first, std::uint32_t last) override {
    const double* sums = rows_.gather(first, last);
    sums_.assign(sums, sums + (last - first) * 6 * kTileSize);
    if (first == 0 && (always_ || ++calls_ == 2)) sums_[40] += added_;
    return sums_.data();
  }
  [[nodiscard]] cuda::DeviceSeconds seconds() const override { return rows_.seconds(); }

 private:
  cuda::HostRows rows_;
  double added_;
  bool always_;
  int calls_ = 0;
  std::vector<double> sums_;
};

TEST(CheckOfRows, FindsAWrongSum) {
  const auto wrong_by = [](double added, bool always) {
    return [added, always](const cuda::RowMatrix& matrix) -> std::unique_ptr<cuda::RowGatherer> {
      return std::make_unique<WrongRows>(matrix, added, always);
    };
  };
  const cuda::RowCheck always = cuda::check_rows(kCase, wrong_by(1e-3, true));
  EXPECT_GT(always.largest_difference, 1e-6);
  EXPECT_TRUE(always.repeats);
  const cuda::RowCheck once = cuda::check_rows(kCase, wrong_by(1e-3, false));
  EXPECT_EQ(once.largest_difference, 0);
  EXPECT_FALSE(once.repeats);
  const cuda::RowCheck no_number = cuda::check_rows(kCase, wrong_by(std::nan(""), true));
  EXPECT_TRUE(std::isinf(no_number.largest_difference));
}

}  // namespace
}  // namespace fluxel
