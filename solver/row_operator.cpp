#include "solver/row_operator.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "formfactor/tile_bounds.hpp"
#include "solver/reductions.hpp"
#include "solver/row_device.hpp"

namespace fluxel {

namespace {

Rgb value_of(const std::array<double, kChannels>& channels) {
  return {channels[0], channels[1], channels[2]};
}
double value_of(const std::array<double, 1>& channels) { return channels[0]; }

template <class Value>
inline constexpr std::size_t kCount = kChannelsOf<Value>;

template <class Value>
using TileIrradiance = std::array<RowIrradiance<kCount<Value>>, kTileSize>;

constexpr TileBits all_bits() {
  TileBits bits{};
  bits.fill(~std::uint64_t{0});
  return bits;
}
constexpr TileBits kAllBits = all_bits();

}  // namespace

struct RowOperator::State {
  std::optional<PairColumns> own_columns;
  PairColumnsView columns;
  std::vector<float> area;  // [m2]
  const TileStore& store;
  const Corrections& corrections;
  KernelRule kernel;
  std::vector<TileShape> shapes;
  std::size_t sides;
  std::size_t elements;
  std::size_t first_element, own;  // elements whose rows are here
  LocalPower local_power;
  PowerExchange* exchange = &local_power;
  SentPower sent;
  double unit = 1;
  RowDevice* device = nullptr;
  tbb::task_arena arena;

  State(std::span<const Element> from, std::optional<PairColumnsView> given, const TileStore& tile_store,
        const Corrections& of_pairs, const KernelRule& rule, bool two_sided, int threads)
      : own_columns(given ? std::nullopt : std::optional<PairColumns>(from)),
        columns(given ? *given : PairColumnsView(*own_columns)),
        store(tile_store),
        corrections(of_pairs),
        kernel(rule),
        sides(two_sided ? 2 : 1),
        elements(from.size()),
        first_element(std::min(elements, store.owned().first * kTileSize)),
        own(std::min(elements, store.owned().last * kTileSize) - first_element),
        local_power(store.tiles(), sides),
        sent{ColumnPower(0, sides, kChannels), ColumnPower(0, sides, kChannels), {}},
        arena(threads) {
    for (const Element& element : from) area.push_back(element.area);
    for (std::size_t tile = 0; tile < store.tiles(); ++tile) shapes.push_back(tile_shape(from, tile));
  }

  /// What turns B into ColumnPower's power of the element.
  [[nodiscard]] double disc(std::size_t i) const {
    return static_cast<double>(columns.area[i]) * std::numbers::inv_pi;
  }

  /// Powers are measured in a power of two near the largest x of all ranks, so that no light is too bright or
  /// too faint for single precision.
  template <class Value>
  void start(std::span<const Value> x) {
    double most = 0;
    for (const Value& value : x)
      for (int c = 0; c < kChannelsOf<Value>; ++c) most = std::max(most, std::abs(channel(value, c)));
    most = largest_over(exchange->ranks(), most);
    unit = most > 0 && std::isfinite(most) ? std::ldexp(1.0, std::ilogb(most)) : 1.0;
    sent = exchange->room(kCount<Value>);
    for (std::size_t tile = store.owned().first; tile < store.owned().last; ++tile) {
      sent.sends[tile] = 0;
      std::ranges::fill(sent.power.lines_of(tile), ColumnPower::Line{});
      std::ranges::fill(sent.rest.lines_of(tile), ColumnPower::Line{});
    }
    for (std::size_t side = 0; side < sides; ++side)
      for (std::size_t k = 0; k < own; ++k) load_power(x, side, k);
    exchange->exchange(sent);
  }

  /// Of a side of own element k.
  template <class Value>
  void load_power(std::span<const Value> x, std::size_t side, std::size_t k) {
    const std::size_t i = first_element + k, tile = i / kTileSize;
    for (int c = 0; c < kChannelsOf<Value>; ++c) {
      const double exact = disc(i) * (channel(x[side * own + k], c) / unit);
      const auto power = static_cast<float>(exact);
      sent.power.of(tile, side, static_cast<std::size_t>(c))[i % kTileSize] = power;
      sent.rest.of(tile, side, static_cast<std::size_t>(c))[i % kTileSize] =
          static_cast<float>(exact - static_cast<double>(power));
      if (power != 0) sent.sends[tile] = 1;  // what is not a number, too
    }
  }

  /// Adds the irradiance that the tiles [first, last) send to the rows of a tile row.
  template <class Value>
  void gather_tiles(std::size_t row_tile, std::size_t first, std::size_t last,
                    TileIrradiance<Value>& sum) const {
    // Blocks are cut at fixed columns, whatever the range, so that sums do not depend on it.
    for (std::size_t block = first; block < last;) {
      const std::size_t end = std::min(last, (block / kBlockTiles + 1) * kBlockTiles);
      gather_block<Value>(kernel.rule, row_tile, block, end, sum);
      if (kernel.rule == PairRule::moments) gather_block<Value>(PairRule::point, row_tile, block, end, sum);
      block = end;
    }
  }

  /// Adds what those tiles of [first, last) send that `rule` is meant for, at most kBlockTiles.
  template <class Value>
  void gather_block(PairRule rule, std::size_t row_tile, std::size_t first, std::size_t last,
                    TileIrradiance<Value>& sum) const {
    std::array<TileBits, kBlockTiles> bits;
    std::array<SeenTile, kBlockTiles> seen;
    std::size_t count = 0;
    for (std::size_t tile = first; tile < last; ++tile) {
      if (sent.sends[tile] == 0) continue;
      const TileTag tag = store.tag(row_tile, tile);
      if (tag != TileTag::visible && tag != TileTag::bits) continue;
      if (rule_between(shapes[row_tile], shapes[tile], kernel) != rule) continue;
      if (tag == TileTag::bits) store.read(row_tile, tile, bits[count]);
      seen[count] = {tile, tag == TileTag::bits ? &bits[count] : &kAllBits};
      ++count;
    }
    if (count == 0) return;
    gather_seen<Value>(rule, row_tile * kTileSize, std::span(seen).first(count),
                       std::span(sum).first(rows_of_tile(row_tile, elements)));
  }

  template <class Value>
  void gather_seen(PairRule rule, std::size_t first_row, std::span<const SeenTile> seen,
                   std::span<RowIrradiance<kCount<Value>>> sums) const {
    fluxel::gather_block({rule, sides == 2, columns, sent.power, first_row, seen}, sums);
  }

  [[nodiscard]] double exact_power(std::size_t side, std::size_t i, std::size_t c) const {
    const std::size_t tile = i / kTileSize, column = i % kTileSize;
    return static_cast<double>(sent.power.of(tile, side, c)[column]) +
           static_cast<double>(sent.rest.of(tile, side, c)[column]);
  }

  /// What the corrections add to the irradiance of an unknown, in units.
  template <class Value>
  [[nodiscard]] Value corrected(std::size_t unknown) const {
    Value sum(0);
    if (corrections.start.empty()) return sum;
    for (std::size_t k = corrections.start[unknown]; k < corrections.start[unknown + 1]; ++k) {
      const std::size_t column = corrections.column[k], side = column / elements, j = column % elements;
      const double factor = static_cast<double>(corrections.G[k]) / disc(j);
      for (int c = 0; c < kChannelsOf<Value>; ++c)
        channel_of(sum, c) += factor * exact_power(side, j, static_cast<std::size_t>(c));
    }
    return sum / static_cast<double>(area[unknown % elements]);
  }

  /// The irradiance of a side of element i from what its row has gathered.
  template <class Value>
  [[nodiscard]] Value irradiance(std::size_t side, std::size_t i,
                                 const RowIrradiance<kCount<Value>>& gathered) const {
    return unit * (value_of(gathered[side]) + corrected<Value>(side * elements + i));
  }

  /// What a device has gathered for a tile row.
  template <class Value>
  [[nodiscard]] TileIrradiance<Value> gathered_sum(const double* of_tile) const {
    TileIrradiance<Value> sum{};
    for (std::size_t side = 0; side < sides; ++side)
      for (std::size_t c = 0; c < kCount<Value>; ++c)
        for (std::size_t r = 0; r < kTileSize; ++r)
          sum[r][side][c] = of_tile[(side * kCount<Value> + c) * kTileSize + r];
    return sum;
  }

  template <class Value>
  void apply(std::span<const Value> x, std::span<Value> H) {
    start(x);
    const TileRows rows = store.owned();
    const bool on_device = device != nullptr && device->start(sent.power, sent.sends);
    const double* const gathered = on_device ? device->gather(rows) : nullptr;
    const std::size_t numbers_of_tile = sides * kCount<Value> * kTileSize;
    arena.execute([&] {
      tbb::parallel_for(rows.first, rows.last, [&](std::size_t row_tile) {
        TileIrradiance<Value> sum{};
        if (gathered != nullptr)
          sum = gathered_sum<Value>(gathered + (row_tile - rows.first) * numbers_of_tile);
        else
          gather_tiles<Value>(row_tile, 0, store.tiles(), sum);
        for (std::size_t r = 0; r < rows_of_tile(row_tile, elements); ++r) {
          const std::size_t i = row_tile * kTileSize + r;
          for (std::size_t side = 0; side < sides; ++side)
            H[side * own + i - first_element] = irradiance<Value>(side, i, sum[r]);
        }
      });
    });
  }

  /// What changes meanwhile is this rank's alone, since others read what has been exchanged.
  template <class Value>
  void sweep(std::span<const Value> E, std::span<const Value> rho, std::span<Value> x) {
    start<Value>(x);
    const auto copy_of = [](std::span<ColumnPower::Line> lines) {
      return std::vector<ColumnPower::Line>(lines.begin(), lines.end());
    };
    std::vector<ColumnPower::Line> power = copy_of(sent.power.lines()), rest = copy_of(sent.rest.lines());
    std::vector<std::uint8_t> sends(sent.sends.begin(), sent.sends.end());
    sent = {ColumnPower(power, sides, kCount<Value>), ColumnPower(rest, sides, kCount<Value>), sends};
    for (std::size_t row_tile = store.owned().first; row_tile < store.owned().last; ++row_tile)
      sweep_tile_row(row_tile, E, rho, x);
  }

  template <class Value>
  void sweep_tile_row(std::size_t row_tile, std::span<const Value> E, std::span<const Value> rho,
                      std::span<Value> x) {
    // What other tile rows send is settled before this one starts: its rows can be summed side by side, in
    // slices of columns. Only the tile on the diagonal has to be done row after row.
    const std::size_t slices = (store.tiles() + kBlockTiles - 1) / kBlockTiles;
    std::vector<TileIrradiance<Value>> slice_sum(slices);
    arena.execute([&] {
      tbb::parallel_for(std::size_t{0}, slices, [&](std::size_t slice) {
        const std::size_t first = slice * kBlockTiles;
        const std::size_t last = std::min(store.tiles(), first + kBlockTiles);
        gather_tiles<Value>(row_tile, first, std::clamp(row_tile, first, last), slice_sum[slice]);
        gather_tiles<Value>(row_tile, std::clamp(row_tile + 1, first, last), last, slice_sum[slice]);
      });
    });
    TileBits bits;
    store.read(row_tile, row_tile, bits);
    const std::array diagonal{SeenTile{row_tile, &bits}};
    for (std::size_t r = 0; r < rows_of_tile(row_tile, elements); ++r) {
      const std::size_t i = row_tile * kTileSize + r;
      std::array<RowIrradiance<kCount<Value>>, 1> sum{};
      gather_seen<Value>(kernel.rule, i, diagonal, sum);
      for (const TileIrradiance<Value>& part : slice_sum)
        for (std::size_t side = 0; side < sides; ++side)
          for (std::size_t c = 0; c < kCount<Value>; ++c) sum[0][side][c] += part[r][side][c];
      for (std::size_t side = 0; side < sides; ++side) {
        const std::size_t unknown = side * own + i - first_element;
        x[unknown] = E[unknown] + rho[unknown] * irradiance<Value>(side, i, sum[0]);
        load_power<Value>(x, side, i - first_element);
      }
    }
  }
};

RowOperator::RowOperator(std::span<const Element> elements, const TileStore& store,
                         const Corrections& corrections, const KernelRule& kernel, bool two_sided,
                         int threads)
    : state_(
          std::make_unique<State>(elements, std::nullopt, store, corrections, kernel, two_sided, threads)) {}

RowOperator::RowOperator(std::span<const Element> elements, PairColumnsView columns, const TileStore& store,
                         const Corrections& corrections, const KernelRule& kernel, bool two_sided,
                         int threads)
    : state_(std::make_unique<State>(elements, columns, store, corrections, kernel, two_sided, threads)) {}

RowOperator::~RowOperator() = default;
RowOperator::RowOperator(RowOperator&&) noexcept = default;

void RowOperator::use(PowerExchange& exchange) { state_->exchange = &exchange; }

void RowOperator::use(RowDevice& device) { state_->device = &device; }

const Ranks& RowOperator::ranks() const { return state_->exchange->ranks(); }

void RowOperator::apply(std::span<const Rgb> x, std::span<Rgb> H) { state_->apply(x, H); }

void RowOperator::apply(std::span<const double> x, std::span<double> H) { state_->apply(x, H); }

void RowOperator::sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) {
  state_->sweep(E, rho, x);
}

void RowOperator::sweep(std::span<const double> E, std::span<const double> rho, std::span<double> x) {
  state_->sweep(E, rho, x);
}

}  // namespace fluxel
