#include "solver/cuda/check_rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "solver/cuda/host_rows.hpp"

namespace fluxel::cuda {

namespace {

/// Tile rows that are compared, and pairs, of which the host makes five million a second and more.
constexpr std::uint32_t kMinCompared = 2, kMaxCompared = 12;
constexpr std::uint64_t kPairsCompared = 30'000'000;

/// The difference from what is no number; kept, as nothing is larger.
constexpr double kUnlike = std::numeric_limits<double>::infinity();

/// Scrambles a number (Steele, Lea & Flood, Fast splittable pseudorandom number generators, 2014).
std::uint64_t mixed(std::uint64_t z) {
  z += 0x9E3779B97F4A7C15u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

/// Uniform in [0, 1), of a number.
double uniform(std::uint64_t z) { return std::ldexp(static_cast<double>(mixed(z) >> 11), -53); }

struct RandomRows {
  const RowCheckCase& of;
  std::uint32_t tiles;
  std::vector<float> columns, power;
  std::vector<std::uint8_t> sends;

  explicit RandomRows(const RowCheckCase& from)
      : of(from),
        tiles((of.elements + kTile - 1) / kTile),
        columns(std::size_t{tiles} * kColumnLines * kTile),
        power(std::size_t{tiles} * lines() * kTile),
        sends(tiles, 1) {
    for (std::uint32_t i = 0; i < tiles * kTile; ++i) i < of.elements ? add_element(i) : add_padding(i);
  }

  [[nodiscard]] std::uint32_t lines() const { return (of.two_sided ? 2 : 1) * of.channels; }

  float& number(std::uint32_t line, std::uint32_t i) {
    return columns[(std::size_t{i / kTile} * kColumnLines + line) * kTile + i % kTile];
  }

  void add_element(std::uint32_t i) {
    std::uint64_t next = std::uint64_t{i} * 32;
    const auto random = [&](double low, double high) { return low + (high - low) * uniform(next++); };
    Double3 normal{random(-1, 1), random(-1, 1), random(-1, 1)};
    normal = 1 / length(normal) * normal;
    Double3 along = cross(normal, Double3{random(-1, 1), random(-1, 1), random(-1, 1)});
    along = 1 / length(along) * along;
    // As squares of about the size that fills the walls of the cube, which centroids are random in.
    const double area = random(0.5, 1.5) * 24 / of.elements, minor_variance = area / 12;
    const double elongation = random(0, 1) * std::sqrt(minor_variance);
    const double vectors[3][3] = {{random(-1, 1), random(-1, 1), random(-1, 1)},
                                  {normal.x, normal.y, normal.z},
                                  {elongation * along.x, elongation * along.y, elongation * along.z}};
    constexpr std::uint32_t kLines[3] = {kCentroidLine, kNormalLine, kElongationLine};
    for (std::uint32_t k = 0; k < 3; ++k)
      for (std::uint32_t axis = 0; axis < 3; ++axis)
        number(kLines[k] + axis, i) = static_cast<float>(vectors[k][axis]);
    number(kDiscLine, i) = static_cast<float>(area / 3.14159265358979323846);
    number(kVarianceLine, i) = static_cast<float>(4 * minor_variance);
    number(kConstantLine, i) = static_cast<float>(4 * minor_variance - elongation * elongation / 2);
    number(kMinR2Line, i) = static_cast<float>(6 * minor_variance);
    for (std::uint32_t line = 0; line < lines(); ++line)
      power[(std::size_t{i / kTile} * lines() + line) * kTile + i % kTile] =
          static_cast<float>(area * random(0, 1));
  }

  void add_padding(std::uint32_t i) {
    for (std::uint32_t axis = 0; axis < 3; ++axis) number(kCentroidLine + axis, i) = 1e3f;
  }

  [[nodiscard]] static std::uint64_t number_of(std::uint32_t row, std::uint32_t column) {
    return std::uint64_t{row} << 32 | column;
  }

  /// Only tiles off the diagonal may be seen whole.
  [[nodiscard]] TileSummary summary(std::uint32_t row, std::uint32_t column) const {
    const double kind = uniform(number_of(row, column));
    const bool far = uniform(~number_of(row, column)) < of.far;
    if (row == column) return {TileSummary::Seen::some, far};
    if (kind < of.nothing) return {TileSummary::Seen::nothing, far};
    return {kind < of.nothing + of.all ? TileSummary::Seen::all : TileSummary::Seen::some, far};
  }

  static void read_bits(std::uint32_t row, std::uint32_t column, std::uint64_t* words) {
    for (std::uint32_t r = 0; r < kTile; ++r) words[r] = mixed(mixed(number_of(row, column)) + r);
    if (row != column) return;
    for (std::uint32_t r = 0; r < kTile; ++r) {  // symmetric, and nothing sees itself
      words[r] &= ~std::uint64_t{0} << r << 1;
      for (std::uint32_t c = 0; c < r; ++c) words[r] |= (words[c] >> r & 1) << c;
    }
  }

  [[nodiscard]] RowMatrix matrix(std::uint32_t first, std::uint32_t last) const {
    return {{of.rule, of.two_sided, tiles, first, last},
            columns.data(),
            [this](std::uint32_t row, std::uint32_t column) { return summary(row, column); },
            read_bits};
  }
};

}  // namespace

RowCheck check_rows(const RowCheckCase& of, const MakeRows& make) {
  const RandomRows random(of);
  RowCheck result{};
  const RowMatrix matrix = random.matrix(0, random.tiles);
  const std::unique_ptr<RowGatherer> rows = make(matrix);
  result.upload_seconds = rows->seconds().transfer;
  result.pairs = static_cast<double>(of.elements) * of.elements;
  for (const TileEntry entry : matrix.entries())
    if (entry.seen() != TileEntry::kNothing) result.gathered_pairs += kTile * kTile;

  const std::size_t items = std::size_t{random.lines()} * kTile;
  const auto product = [&] {
    rows->start(random.power.data(), random.sends.data(), of.channels);
    const double* sums = rows->gather(0, random.tiles);
    return std::vector<double>(sums, sums + random.tiles * items);
  };
  // As bytes, since rows of padding are no numbers.
  const auto same = [](const double* a, const double* b, std::size_t count) {
    return std::memcmp(a, b, count * sizeof(double)) == 0;
  };
  const std::vector<double> whole = product();
  const DeviceSeconds before = rows->seconds();
  result.repeats = same(product().data(), whole.data(), whole.size());
  result.kernel_seconds = rows->seconds().kernel - before.kernel;
  result.transfer_seconds = rows->seconds().transfer - before.transfer;

  double largest = 0, difference = 0;
  const std::uint64_t affordable = kPairsCompared / (std::uint64_t{kTile} * of.elements);
  const std::uint32_t compared =
      std::min(random.tiles,
               static_cast<std::uint32_t>(std::clamp<std::uint64_t>(affordable, kMinCompared, kMaxCompared)));
  for (std::uint32_t k = 0; k < compared; ++k) {
    // The first and the last are among them.
    const std::uint32_t row =
        compared == 1 ? 0
                      : static_cast<std::uint32_t>(std::uint64_t{k} * (random.tiles - 1) / (compared - 1));
    HostRows host(random.matrix(row, row + 1));
    host.start(random.power.data(), random.sends.data(), of.channels);
    const double* expected = host.gather(row, row + 1);
    const double* found = whole.data() + row * items;
    result.repeats = result.repeats && same(rows->gather(row, row + 1), found, items);
    for (std::size_t item = 0; item < items; ++item) {
      if (row * kTile + item % kTile >= of.elements) continue;
      largest = std::max(largest, std::fabs(expected[item]));
      const double off = std::fabs(found[item] - expected[item]);
      difference = std::isfinite(off) ? std::max(difference, off) : kUnlike;
    }
  }
  result.compared_tile_rows = compared;
  result.largest_difference = largest > 0 ? difference / largest : difference;
  return result;
}

}  // namespace fluxel::cuda
