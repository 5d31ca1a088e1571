#include "solver/row_operator.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <variant>

#include "formfactor/tile_bounds.hpp"
#include "solver/channels.hpp"
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
  ColumnPower power;
  std::vector<std::uint8_t> sends;  // tiles that have any power
  double unit = 1;
  std::variant<std::span<const Rgb>, std::span<const double>> started;
  RowDevice* device = nullptr;
  bool on_device = false;  // what has been started
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
        power(store.tiles(), sides, kChannels),
        arena(threads) {
    for (const Element& element : from) area.push_back(element.area);
    for (std::size_t tile = 0; tile < store.tiles(); ++tile) shapes.push_back(tile_shape(from, tile));
  }

  /// Powers are measured in a power of two near the largest x, so that no light is too bright or too faint
  /// for single precision.
  template <class Value>
  void load_all(std::span<const Value> x) {
    if (power.channels() != kCount<Value>) power = ColumnPower(store.tiles(), sides, kCount<Value>);
    double most = 0;
    for (const Value& value : x)
      for (int c = 0; c < kChannelsOf<Value>; ++c) most = std::max(most, std::abs(channel(value, c)));
    unit = most > 0 && std::isfinite(most) ? std::ldexp(1.0, std::ilogb(most)) : 1.0;
    sends.assign(store.tiles(), 0);
    for (std::size_t i = 0; i < elements; ++i) load_power(x, i);
  }

  template <class Value>
  void load_power(std::span<const Value> x, std::size_t i) {
    const std::size_t tile = i / kTileSize;
    const double disc = static_cast<double>(columns.area[i]) * std::numbers::inv_pi;
    for (std::size_t side = 0; side < sides; ++side) {
      for (int c = 0; c < kChannelsOf<Value>; ++c) {
        const auto sent = static_cast<float>(disc * (channel(x[side * elements + i], c) / unit));
        power.of(tile, side, static_cast<std::size_t>(c))[i % kTileSize] = sent;
        if (sent != 0) sends[tile] = 1;  // what is not a number, too
      }
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
      if (sends[tile] == 0) continue;
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
    fluxel::gather_block({rule, sides == 2, columns, power, first_row, seen}, sums);
  }

  /// What the corrections add to the irradiance of an unknown.
  template <class Value>
  [[nodiscard]] Value corrected(std::size_t unknown, std::span<const Value> x) const {
    Value sum(0);
    if (corrections.start.empty()) return sum;
    for (std::size_t k = corrections.start[unknown]; k < corrections.start[unknown + 1]; ++k)
      sum += static_cast<double>(corrections.G[k]) * x[corrections.column[k]];
    return sum / static_cast<double>(area[unknown % elements]);
  }

  /// The irradiance of an unknown from what its row has gathered.
  template <class Value>
  [[nodiscard]] Value irradiance(std::size_t side, std::size_t i,
                                 const RowIrradiance<kCount<Value>>& gathered,
                                 std::span<const Value> x) const {
    return unit * value_of(gathered[side]) + corrected(side * elements + i, x);
  }

  template <class Value>
  void start(std::span<const Value> x) {
    load_all(x);
    started = x;
    on_device = device != nullptr && device->start(power, sends);
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
  void apply_rows(TileRows rows, std::span<Value> H) {
    const auto x = std::get<std::span<const Value>>(started);
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
            H[side * elements + i] = irradiance<Value>(side, i, sum[r], x);
        }
      });
    });
  }

  template <class Value>
  void sweep(std::span<const Value> E, std::span<const Value> rho, std::span<Value> x) {
    load_all<Value>(x);
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
        const std::size_t unknown = side * elements + i;
        x[unknown] = E[unknown] + rho[unknown] * irradiance<Value>(side, i, sum[0], x);
      }
      load_power<Value>(x, i);
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

void RowOperator::use(RowDevice& device) { state_->device = &device; }

const TileRows& RowOperator::owned() const { return state_->store.owned(); }

std::size_t RowOperator::first_row() const {
  return std::min(state_->elements, state_->store.owned().first * kTileSize);
}

std::size_t RowOperator::last_row() const {
  return std::min(state_->elements, state_->store.owned().last * kTileSize);
}

void RowOperator::start(std::span<const Rgb> x) { state_->start(x); }
void RowOperator::start(std::span<const double> x) { state_->start(x); }

void RowOperator::apply_rows(TileRows rows, std::span<Rgb> H) { state_->apply_rows(rows, H); }
void RowOperator::apply_rows(TileRows rows, std::span<double> H) { state_->apply_rows(rows, H); }

void RowOperator::apply(std::span<const Rgb> x, std::span<Rgb> H) {
  start(x);
  apply_rows(state_->store.owned(), H);
}

void RowOperator::apply(std::span<const double> x, std::span<double> H) {
  start(x);
  apply_rows(state_->store.owned(), H);
}

void RowOperator::sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) {
  state_->sweep(E, rho, x);
}

void RowOperator::sweep(std::span<const double> E, std::span<const double> rho, std::span<double> x) {
  state_->sweep(E, rho, x);
}

}  // namespace fluxel
