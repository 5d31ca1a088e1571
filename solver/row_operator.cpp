#include "solver/row_operator.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "formfactor/tile_bounds.hpp"

namespace fluxel {

namespace {

using TileIrradiance = std::array<RowIrradiance, kTileSize>;

/// Columns of one block of tiles as words, a row of the tile after another.
using BlockWords = std::array<std::array<std::uint64_t, kBlockTiles>, kTileSize>;

}  // namespace

struct RowOperator::State {
  PairColumns columns;
  ColumnPower power;
  std::vector<float> area;  // [m2]
  const TileStore& store;
  const Corrections& corrections;
  KernelRule kernel;
  std::vector<TileShape> shapes;
  bool two_sided;
  std::size_t elements;
  double unit = 1;
  tbb::task_arena arena;

  State(std::span<const Element> from, const TileStore& tile_store, const Corrections& of_pairs,
        const KernelRule& rule, bool two, int threads)
      : columns(from),
        store(tile_store),
        corrections(of_pairs),
        kernel(rule),
        two_sided(two),
        elements(from.size()),
        arena(threads) {
    for (const Element& element : from) area.push_back(element.area);
    for (std::size_t tile = 0; tile < store.tiles(); ++tile) shapes.push_back(tile_shape(from, tile));
    for (std::size_t side = 0; side < (two_sided ? 2u : 1u); ++side)
      for (std::vector<float>& channel : power.of[side]) channel.assign(columns.padded(), 0);
  }

  /// Powers are measured in a power of two near the largest x, so that no light is too bright or too faint
  /// for single precision.
  void load_all(std::span<const Rgb> x) {
    double most = 0;
    for (const Rgb& value : x) most = std::max({most, value.r, value.g, value.b});
    unit = most > 0 && std::isfinite(most) ? std::ldexp(1.0, std::ilogb(most)) : 1.0;
    load_power(x, 0, elements);
  }

  void load_power(std::span<const Rgb> x, std::size_t first, std::size_t last) {
    for (std::size_t side = 0; side < (two_sided ? 2u : 1u); ++side)
      for (std::size_t channel = 0; channel < kChannels; ++channel)
        for (std::size_t i = first; i < last; ++i)
          power.of[side][channel][i] =
              static_cast<float>(static_cast<double>(columns.area[i]) *
                                 (x[side * elements + i][static_cast<int>(channel)] / unit));
  }

  [[nodiscard]] RowIrradiance one_row(PairRule rule, std::size_t row, std::size_t first_tile,
                                      std::span<const std::uint64_t> words) const {
    RowIrradiance H = gather_row(rule, two_sided, columns, power, row, first_tile, words);
    H.front *= unit;
    H.back *= unit;
    return H;
  }

  /// Adds the irradiance that the tiles [first, last) send to the rows of a tile row.
  void gather_tiles(std::size_t row_tile, std::size_t first, std::size_t last, TileIrradiance& sum) const {
    // Blocks are cut at fixed columns, whatever the range, so that sums do not depend on it.
    for (std::size_t block = first; block < last;) {
      const std::size_t end = std::min(last, (block / kBlockTiles + 1) * kBlockTiles);
      gather_block(kernel.rule, row_tile, block, end, sum);
      if (kernel.rule == PairRule::moments) gather_block(PairRule::point, row_tile, block, end, sum);
      block = end;
    }
  }

  /// Adds what those tiles of [first, last) send that `rule` is meant for, at most kBlockTiles.
  void gather_block(PairRule rule, std::size_t row_tile, std::size_t first, std::size_t last,
                    TileIrradiance& sum) const {
    const std::size_t rows = rows_of_tile(row_tile, elements);
    BlockWords words;
    TileBits bits;
    bool empty = true;
    for (std::size_t tile = first; tile < last; ++tile) {
      const TileTag tag = store.tag(row_tile, tile);
      const bool sends = (tag == TileTag::visible || tag == TileTag::bits) &&
                         rule_between(shapes[row_tile], shapes[tile], kernel) == rule;
      if (sends) store.read(row_tile, tile, bits);
      for (std::size_t r = 0; r < rows; ++r) words[r][tile - first] = sends ? bits[r] : 0;
      empty = empty && !sends;
    }
    if (empty) return;
    for (std::size_t r = 0; r < rows; ++r) {
      const RowIrradiance part =
          one_row(rule, row_tile * kTileSize + r, first, std::span(words[r]).first(last - first));
      sum[r].front += part.front;
      sum[r].back += part.back;
    }
  }

  /// What the corrections add to the irradiance of an unknown.
  [[nodiscard]] Rgb corrected(std::size_t unknown, std::span<const Rgb> x) const {
    Rgb sum(0);
    if (corrections.start.empty()) return sum;
    for (std::size_t k = corrections.start[unknown]; k < corrections.start[unknown + 1]; ++k)
      sum += static_cast<double>(corrections.G[k]) * x[corrections.column[k]];
    return sum / static_cast<double>(area[unknown % elements]);
  }

  void store_row(std::size_t i, const RowIrradiance& H, std::span<const Rgb> x, std::span<Rgb> out) const {
    out[i] = H.front + corrected(i, x);
    if (two_sided) out[elements + i] = H.back + corrected(elements + i, x);
  }
};

RowOperator::RowOperator(std::span<const Element> elements, const TileStore& store,
                         const Corrections& corrections, const KernelRule& kernel, bool two_sided,
                         int threads)
    : state_(std::make_unique<State>(elements, store, corrections, kernel, two_sided, threads)) {}

RowOperator::~RowOperator() = default;

std::size_t RowOperator::first_row() const {
  return std::min(state_->elements, state_->store.owned().first * kTileSize);
}

std::size_t RowOperator::last_row() const {
  return std::min(state_->elements, state_->store.owned().last * kTileSize);
}

void RowOperator::apply(std::span<const Rgb> x, std::span<Rgb> H) {
  State& state = *state_;
  state.load_all(x);
  const TileRows owned = state.store.owned();
  state.arena.execute([&] {
    tbb::parallel_for(owned.first, owned.last, [&](std::size_t row_tile) {
      TileIrradiance sum{};
      state.gather_tiles(row_tile, 0, state.store.tiles(), sum);
      for (std::size_t r = 0; r < rows_of_tile(row_tile, state.elements); ++r)
        state.store_row(row_tile * kTileSize + r, sum[r], x, H);
    });
  });
}

void RowOperator::sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) {
  State& state = *state_;
  state.load_all(x);
  const TileRows owned = state.store.owned();
  for (std::size_t row_tile = owned.first; row_tile < owned.last; ++row_tile) {
    // What other tile rows send is settled before this one starts: its rows can be summed side by side, in
    // slices of columns. Only the tile on the diagonal has to be done row after row.
    const std::size_t slices = (state.store.tiles() + kBlockTiles - 1) / kBlockTiles;
    std::vector<TileIrradiance> slice_sum(slices);
    state.arena.execute([&] {
      tbb::parallel_for(std::size_t{0}, slices, [&](std::size_t slice) {
        const std::size_t first = slice * kBlockTiles;
        const std::size_t last = std::min(state.store.tiles(), first + kBlockTiles);
        state.gather_tiles(row_tile, first, std::clamp(row_tile, first, last), slice_sum[slice]);
        state.gather_tiles(row_tile, std::clamp(row_tile + 1, first, last), last, slice_sum[slice]);
      });
    });
    TileBits diagonal;
    state.store.read(row_tile, row_tile, diagonal);
    for (std::size_t r = 0; r < rows_of_tile(row_tile, state.elements); ++r) {
      const std::size_t i = row_tile * kTileSize + r;
      RowIrradiance H = state.one_row(state.kernel.rule, i, row_tile, std::span(diagonal).subspan(r, 1));
      for (const TileIrradiance& part : slice_sum) {
        H.front += part[r].front;
        H.back += part[r].back;
      }
      x[i] = E[i] + rho[i] * (H.front + state.corrected(i, x));
      if (state.two_sided) {
        const std::size_t back = state.elements + i;
        x[back] = E[back] + rho[back] * (H.back + state.corrected(back, x));
      }
      state.load_power(x, i, i + 1);
    }
  }
}

// Through three channels, for now.
void RowOperator::apply(std::span<const double> x, std::span<double> H) {
  std::vector<Rgb> wide_x(x.begin(), x.end()), wide_H(H.begin(), H.end());
  apply(wide_x, wide_H);
  for (std::size_t i = 0; i < H.size(); ++i) H[i] = wide_H[i].r;
}

void RowOperator::sweep(std::span<const double> E, std::span<const double> rho, std::span<double> x) {
  std::vector<Rgb> wide_E(E.begin(), E.end()), wide_rho(rho.begin(), rho.end()), wide_x(x.begin(), x.end());
  sweep(wide_E, wide_rho, wide_x);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = wide_x[i].r;
}

}  // namespace fluxel
