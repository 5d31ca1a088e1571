#include "solver/row_device.hpp"

#include <algorithm>
#include <vector>

#include "formfactor/tile_bounds.hpp"
#include "solver/cuda/device_rows.hpp"

namespace fluxel {

namespace {

// What both sides of the border between C++20 and the device's C++17 must agree on.
static_assert(kTileSize == cuda::kTile);
static_assert(static_cast<int>(PairRule::point) == static_cast<int>(cuda::Rule::point));
static_assert(static_cast<int>(PairRule::disc) == static_cast<int>(cuda::Rule::disc));
static_assert(static_cast<int>(PairRule::moments) == static_cast<int>(cuda::Rule::moments));
constexpr std::size_t line_at(std::size_t offset) { return offset / sizeof(TileFloats); }
static_assert(line_at(sizeof(TileColumns)) == cuda::kColumnLines);
static_assert(line_at(offsetof(TileColumns, x)) == cuda::kCentroidLine);
static_assert(line_at(offsetof(TileColumns, normal_x)) == cuda::kNormalLine);
static_assert(line_at(offsetof(TileColumns, disc)) == cuda::kDiscLine);
static_assert(line_at(offsetof(TileColumns, elongation_x)) == cuda::kElongationLine);
static_assert(line_at(offsetof(TileColumns, variance4)) == cuda::kVarianceLine);
static_assert(line_at(offsetof(TileColumns, constant)) == cuda::kConstantLine);
static_assert(line_at(offsetof(TileColumns, least_r2)) == cuda::kMinR2Line);

cuda::TileSummary::Seen seen_of(TileTag tag) {
  switch (tag) {
    case TileTag::visible:
      return cuda::TileSummary::Seen::all;
    case TileTag::bits:
      return cuda::TileSummary::Seen::some;
    case TileTag::blocked:
    case TileTag::facing_away:
      break;
  }
  return cuda::TileSummary::Seen::nothing;
}

}  // namespace

cuda::RowMatrix row_matrix(std::span<const Element> elements, PairColumnsView columns, const TileStore& store,
                           const KernelRule& kernel, bool two_sided) {
  std::vector<TileShape> shapes;
  for (std::size_t tile = 0; tile < store.tiles(); ++tile) shapes.push_back(tile_shape(elements, tile));
  const auto summary_of = [&](std::uint32_t row, std::uint32_t column) {
    return cuda::TileSummary{seen_of(store.tag(row, column)),
                             rule_between(shapes[row], shapes[column], kernel) != kernel.rule};
  };
  const auto read_bits = [&store](std::uint32_t row, std::uint32_t column, std::uint64_t* words) {
    TileBits bits;
    store.read(row, column, bits);
    std::ranges::copy(bits, words);
  };
  const cuda::RowShape shape{
      static_cast<cuda::Rule>(kernel.rule), two_sided, static_cast<std::uint32_t>(store.tiles()),
      static_cast<std::uint32_t>(store.owned().first), static_cast<std::uint32_t>(store.owned().last)};
  return {shape, reinterpret_cast<const float*>(columns.tiles.data()), summary_of, read_bits};
}

std::unique_ptr<cuda::RowGatherer> make_device_rows(const cuda::RowMatrix& rows, int device,
                                                    std::size_t memory) {
  return std::make_unique<cuda::DeviceRows>(rows, device, memory);
}

bool RowDevice::attempt(const std::function<void()>& work) {
  if (!works()) return false;
  try {
    work();
    return true;
  } catch (const cuda::DeviceError& error) {
    taken_ = rows_->seconds();
    rows_.reset();
    when_it_fails_(error);
    return false;
  }
}

bool RowDevice::start(const ColumnPower& power, std::span<const std::uint8_t> sends) {
  return attempt(
      [&] { rows_->start(power.of(0), sends.data(), static_cast<std::uint32_t>(power.channels())); });
}

const double* RowDevice::gather(TileRows rows) {
  const double* sums = nullptr;
  attempt([&] {
    sums = rows_->gather(static_cast<std::uint32_t>(rows.first), static_cast<std::uint32_t>(rows.last));
  });
  return sums;
}

}  // namespace fluxel
