#include "bench/solver/kernel_rates.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <stdexcept>
#include <vector>

#include "bench/solver/fma_peak.hpp"
#include "bench/solver/plain_loop.hpp"
#include "bench/visibility/csv_file.hpp"
#include "bench/visibility/stopwatch.hpp"
#include "core/error.hpp"
#include "solver/pair_kernel.hpp"
#include "tests/unit/closed_box.hpp"
#include "visibility/instruction_set.hpp"

namespace fluxel::bench {

namespace {

/// What of the problem decides the kernel's path.
struct Kind {
  bool all_visible;
  bool flat;  // tiles lie in planes
};

/// Multiplications of a pair in the kernel, those fused with a sum as one, read off solver/pair_kernel.cpp;
/// sums that stand alone, masks and the division run beside them.
std::size_t multiplications(const PlainCase& what, bool flat) {
  constexpr std::size_t kDistance = 3, kDot = 3;
  // point and disc: the heights' product and the denominator. moments: that product, w (2), both elements'
  // parts (8 each), the second-order term, the bracket, 1 / r^4 and the last product; the square of the row's
  // height is made once a row of a flat tile.
  const std::size_t of_rule =
      what.rule == PairRule::moments ? 1 + 2 + 2 * 8 + 1 + 1 + 1 + 1 - (flat ? 1 : 0) : 2;
  // Heights; of moments the cosine of the normals and both turns as well.
  const std::size_t of_planes = flat ? 0 : what.rule == PairRule::moments ? 5 * kDot : 2 * kDot;
  return kDistance + of_planes + of_rule +
         what.channels;  // two-sided, a vector is mostly on one side of its row
}

/// The inside of a box, of which by chance every other tile is turned out, or every other element, so that
/// both sides are met.
std::vector<Element> box_elements(std::size_t count, bool flat, std::mt19937_64& random) {
  std::size_t along = 8;
  while (6 * along * along < count) along += 8;
  std::vector<Element> elements = test_scenes::ClosedBox(along).elements;
  elements.resize(count);
  bool turned = false;
  for (std::size_t k = 0; k < elements.size(); ++k) {
    if (!flat || k % kTileSize == 0) turned = random() % 2 == 0;
    if (turned) elements[k].normal = -elements[k].normal;
  }
  return elements;
}

/// One problem, as the kernel and as the plain loop want it.
class Problem {
 public:
  Problem(const KernelSettings& settings, const Kind& kind) : rows_(settings.rows) {
    std::mt19937_64 random(1);
    const std::vector<Element> elements = box_elements(settings.elements, kind.flat, random);
    columns_ = PairColumns(elements);
    for (std::size_t tile_row = 0; tile_row < rows_ / kTileSize; ++tile_row)
      for (std::size_t tile = 0; tile < columns_.tiles.size(); ++tile)
        bits_.push_back(random_bits(kind.all_visible, tile_row == tile, random));
    words_.resize(rows_ * columns_.tiles.size());
    for (std::size_t row = 0; row < rows_; ++row)
      for (std::size_t tile = 0; tile < columns_.tiles.size(); ++tile)
        words_[row * columns_.tiles.size() + tile] = bits_of(row / kTileSize, tile)[row % kTileSize];
    fill_plain(random);
  }

  [[nodiscard]] double pairs() const {
    return static_cast<double>(rows_) * static_cast<double>(columns_.tiles.size() * kTileSize);
  }

  [[nodiscard]] ColumnPower power_for(const PlainCase& what) const {
    ColumnPower power(columns_.tiles.size(), what.two_sided ? 2 : 1, what.channels);
    for (std::size_t side = 0; side < (what.two_sided ? 2u : 1u); ++side)
      for (std::size_t c = 0; c < what.channels; ++c)
        for (std::size_t j = 0; j < columns_.area.size(); ++j)
          power.of(j / kTileSize, side, c)[j % kTileSize] = plain_.power[side][c][j];
    return power;
  }

  /// Sum of all that all rows gather: of the kernel, of the plain loop.
  template <std::size_t channels>
  [[nodiscard]] double by_kernel(const PlainCase& what, const ColumnPower& power) const {
    double total = 0;
    std::array<SeenTile, kBlockTiles> seen;
    for (std::size_t tile_row = 0; tile_row < rows_ / kTileSize; ++tile_row) {
      std::array<RowIrradiance<channels>, kTileSize> sums{};
      for (std::size_t first = 0; first < columns_.tiles.size(); first += kBlockTiles) {
        for (std::size_t t = 0; t < kBlockTiles; ++t) seen[t] = {first + t, &bits_of(tile_row, first + t)};
        gather_block({what.rule, what.two_sided, columns_, power, tile_row * kTileSize, seen}, sums);
      }
      for (const RowIrradiance<channels>& sum : sums)
        for (std::size_t c = 0; c < channels; ++c) total += sum[0][c] + sum[1][c];
    }
    return total;
  }

  template <class PlainRow>
  [[nodiscard]] double by_loop(const PlainRow& plain_row, const PlainCase& what) const {
    double total = 0;
    const std::size_t tiles = columns_.tiles.size();
    for (std::size_t row = 0; row < rows_; ++row) {
      PlainSums sums{};
      plain_row(what, plain_, row, std::span(words_).subspan(row * tiles, tiles), sums);
      for (const auto& side : sums)
        for (const double sum : side) total += sum;
    }
    return total;
  }

 private:
  std::size_t rows_;
  PairColumns columns_{{}};
  std::vector<TileBits> bits_;  // of each tile row and tile
  std::vector<std::uint64_t> words_;
  std::vector<std::vector<float>> arrays_;
  PlainColumns plain_{};

  [[nodiscard]] const TileBits& bits_of(std::size_t tile_row, std::size_t tile) const {
    return bits_[tile_row * columns_.tiles.size() + tile];
  }

  static TileBits random_bits(bool all_visible, bool diagonal, std::mt19937_64& random) {
    TileBits bits;
    for (std::size_t r = 0; r < kTileSize; ++r) {
      bits[r] = all_visible ? ~std::uint64_t{0} : random();
      if (diagonal) bits[r] &= ~(std::uint64_t{1} << r);
    }
    return bits;
  }

  void fill_plain(std::mt19937_64& random) {
    const auto copy = [&](TileFloats TileColumns::*number) {
      std::vector<float>& array = arrays_.emplace_back();
      for (const TileColumns& tile : columns_.tiles)
        array.insert(array.end(), (tile.*number).begin(), (tile.*number).end());
      return array.data();
    };
    plain_.x = copy(&TileColumns::x);
    plain_.y = copy(&TileColumns::y);
    plain_.z = copy(&TileColumns::z);
    plain_.normal_x = copy(&TileColumns::normal_x);
    plain_.normal_y = copy(&TileColumns::normal_y);
    plain_.normal_z = copy(&TileColumns::normal_z);
    plain_.disc = copy(&TileColumns::disc);
    plain_.elongation_x = copy(&TileColumns::elongation_x);
    plain_.elongation_y = copy(&TileColumns::elongation_y);
    plain_.elongation_z = copy(&TileColumns::elongation_z);
    plain_.variance4 = copy(&TileColumns::variance4);
    plain_.constant = copy(&TileColumns::constant);
    plain_.least_r2 = copy(&TileColumns::least_r2);
    std::uniform_real_distribution<float> value(0.5f, 1.5f);
    for (auto& side : plain_.power) {
      for (const float*& channel : side) {
        std::vector<float>& array = arrays_.emplace_back();
        for (const float area : columns_.area) array.push_back(area * value(random));
        channel = array.data();
      }
    }
  }
};

struct Rates {
  double kernel = 0, shifts = 0, as_built = 0, same_set = 0, bound = 0;  // pairs a second
  double over_shifts = 0, over_as_built = 0, over_same_set = 0, of_bound = 0;
};

using PlainRow = decltype(&plain_row_as_built);

PlainRow plain_row_for(Isa isa) {
  return isa == Isa::avx512 ? plain_row_avx512 : isa == Isa::avx2 ? plain_row_avx2 : plain_row_sse4;
}

Rates measure(const Problem& problem, const PlainCase& what, bool flat, Isa isa, int repetitions) {
  use_instruction_set(isa);
  const ColumnPower power = problem.power_for(what);
  std::vector<double> kernel, shifts, as_built, same_set, bound;
  std::vector<double> over_shifts, over_as_built, over_same_set, of_bound;
  for (int k = 0; k < repetitions; ++k) {
    double sum = 0, sum_shifts = 0, sum_as_built = 0, sum_same_set = 0;
    const double kernel_seconds = thread_seconds_of([&] {
      sum = what.channels == 1 ? problem.by_kernel<1>(what, power) : problem.by_kernel<3>(what, power);
    });
    const double shifts_seconds =
        thread_seconds_of([&] { sum_shifts = problem.by_loop(plain_row_shifts, what); });
    const double as_built_seconds =
        thread_seconds_of([&] { sum_as_built = problem.by_loop(plain_row_as_built, what); });
    const double same_set_seconds =
        thread_seconds_of([&] { sum_same_set = problem.by_loop(plain_row_for(isa), what); });
    for (const double other : {sum_shifts, sum_as_built, sum_same_set})
      if (!(std::abs(other - sum) < 1e-5 * sum))
        throw std::logic_error("the plain loop adds up to something else");
    kernel.push_back(problem.pairs() / kernel_seconds);
    shifts.push_back(problem.pairs() / shifts_seconds);
    as_built.push_back(problem.pairs() / as_built_seconds);
    same_set.push_back(problem.pairs() / same_set_seconds);
    bound.push_back(fma_peak() / static_cast<double>(multiplications(what, flat)));
    over_shifts.push_back(kernel.back() / shifts.back());
    over_as_built.push_back(kernel.back() / as_built.back());
    over_same_set.push_back(kernel.back() / same_set.back());
    of_bound.push_back(kernel.back() / bound.back());
  }
  return {median(kernel),      median(shifts),        median(as_built),      median(same_set), median(bound),
          median(over_shifts), median(over_as_built), median(over_same_set), median(of_bound)};
}

const char* name_of_rule(PairRule rule) {
  return rule == PairRule::point ? "point" : rule == PairRule::disc ? "disc" : "moments";
}

void print_line(Isa isa, const PlainCase& what, const Kind& kind, const Rates& rates) {
  fmt::print(
      "{:>7} {:>8} {:>5} {:>4} {:>7} {:>6} {:8.3f} {:8.3f} {:8.3f} {:8.3f} {:8.3f} {:4} {:8.2f} {:8.2f} "
      "{:8.2f} "
      "{:8.2f}\n",
      name_of(isa), name_of_rule(what.rule), what.two_sided ? "two" : "one",
      what.channels == 1 ? "grey" : "RGB", kind.all_visible ? "all" : "half", kind.flat ? "planes" : "any",
      1e-9 * rates.kernel, 1e-9 * rates.shifts, 1e-9 * rates.as_built, 1e-9 * rates.same_set,
      1e-9 * rates.bound, multiplications(what, kind.flat), rates.over_shifts, rates.over_as_built,
      rates.over_same_set, rates.of_bound);
  std::fflush(stdout);
}

}  // namespace

void run_kernel(const KernelSettings& settings) {
  if (settings.rows == 0 || settings.rows % kTileSize != 0 ||
      settings.elements % (kBlockTiles * kTileSize) != 0 || settings.elements < settings.rows)
    throw InputError("rows must be tiles of 64, elements blocks of 512 and no fewer than rows");
  CsvFile table(settings.csv);
  fmt::print("{} rows of {} columns, one thread; 10^9 pairs a second\n", settings.rows, settings.elements);
  fmt::print(
      "{:>7} {:>8} {:>5} {:>4} {:>7} {:>6} {:>8} {:>8} {:>8} {:>8} {:>8} {:>4} {:>8} {:>8} {:>8} {:>8}\n",
      "isa", "rule", "sides", "", "visible", "tiles", "kernel", "shifts", "loop", "loop isa", "bound", "mult",
      "/shifts", "/loop", "/loop isa", "/bound");
  for (const Kind& kind : {Kind{false, true}, Kind{true, true}, Kind{true, false}}) {
    const Problem problem(settings, kind);
    for (const Isa isa : supported_instruction_sets()) {
      for (const std::size_t channels : {std::size_t{3}, std::size_t{1}}) {
        for (const PlainCase& what :
             {PlainCase{PairRule::point, false, channels}, PlainCase{PairRule::disc, false, channels},
              PlainCase{PairRule::moments, false, channels}, PlainCase{PairRule::point, true, channels},
              PlainCase{PairRule::moments, true, channels}}) {
          const Rates rates = measure(problem, what, kind.flat, isa, settings.repetitions);
          print_line(isa, what, kind, rates);
          table.add({{"isa", name_of(isa)},
                     {"rule", name_of_rule(what.rule)},
                     {"sides", what.two_sided ? "two" : "one"},
                     {"visible", kind.all_visible ? "all" : "half"},
                     {"tiles", kind.flat ? "planes" : "any"}},
                    {{"channels", static_cast<double>(channels)},
                     {"kernel", rates.kernel},
                     {"loop_by_shifts", rates.shifts},
                     {"loop", rates.as_built},
                     {"loop_same_set", rates.same_set},
                     {"bound", rates.bound},
                     {"multiplications", static_cast<double>(multiplications(what, kind.flat))},
                     {"over_loop_by_shifts", rates.over_shifts},
                     {"over_loop", rates.over_as_built},
                     {"over_loop_same_set", rates.over_same_set},
                     {"of_bound", rates.of_bound}});
        }
      }
    }
  }
  use_instruction_set(Isa::automatic);
}

}  // namespace fluxel::bench
