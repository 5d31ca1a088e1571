#include "visibility/tile_code.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <stdexcept>

namespace fluxel {

namespace {

static_assert(std::endian::native == std::endian::little, "bits are read as words");

constexpr unsigned kCountBits = 6;
constexpr unsigned kChangeBits = kTileSize - 1;

/// 64 bits from any bit on; may touch the 9 bytes that hold them.
class BitReader {
 public:
  explicit BitReader(const std::byte* bytes) : bytes_(bytes) {}

  [[nodiscard]] std::uint64_t peek() const {
    const std::byte* at = bytes_ + position_ / 8;
    std::uint64_t low;
    std::memcpy(&low, at, sizeof low);
    const unsigned shift = position_ % 8;
    const auto high = std::to_integer<std::uint64_t>(at[8]);
    return low >> shift | high << 1 << (63 - shift);
  }
  void skip(unsigned bits) { position_ += bits; }
  [[nodiscard]] unsigned position() const { return position_; }

 private:
  const std::byte* bytes_;
  unsigned position_ = 0;
};

/// Appends bits to zeroed bytes.
class BitWriter {
 public:
  explicit BitWriter(std::byte* bytes) : bytes_(bytes) {}

  /// `value` has no bits beyond its lowest `bits`.
  void write(std::uint64_t value, unsigned bits) {
    std::byte* at = bytes_ + position_ / 8;
    const unsigned shift = position_ % 8;
    std::uint64_t low;
    std::memcpy(&low, at, sizeof low);
    low |= value << shift;
    std::memcpy(at, &low, sizeof low);
    if (shift + bits > 64) at[8] = static_cast<std::byte>(value >> (64 - shift));
    position_ += bits;
  }
  [[nodiscard]] std::size_t bytes() const { return (position_ + 7) / 8; }

 private:
  std::byte* bytes_;
  unsigned position_ = 0;
};

/// Which of 64 lines, rows or columns, are alike.
struct LineMap {
  unsigned different = kTileSize;
  std::array<std::uint8_t, kTileSize> first{};  ///< the first line like each different one
  std::uint64_t changed = 0;                    ///< bit k: line k + 1 differs from line k
  std::uint64_t is_new = 0;                     ///< for each that does: it is like none before
  std::array<std::uint8_t, kTileSize> old{};    ///< for each that is not new: which it is like
  unsigned olds = 0;

  [[nodiscard]] unsigned index_bits() const { return static_cast<unsigned>(std::bit_width(different - 1)); }
  [[nodiscard]] unsigned changes() const { return static_cast<unsigned>(std::popcount(changed)); }
  [[nodiscard]] unsigned bits() const {
    return different == kTileSize ? 0 : kChangeBits + changes() + olds * index_bits();
  }
};

LineMap all_different() {
  LineMap map;
  for (std::size_t k = 0; k < kTileSize; ++k) map.first[k] = static_cast<std::uint8_t>(k);
  return map;
}

LineMap find_alike(const TileBits& lines) {
  // Open addressing; twice as many places as there can be lines.
  constexpr std::size_t kPlaces = 2 * kTileSize;
  constexpr std::uint8_t kFree = 0xFF;
  std::array<std::uint8_t, kPlaces> table;
  table.fill(kFree);
  LineMap map;
  map.different = 0;
  unsigned changes = 0;
  for (std::size_t k = 0; k < kTileSize; ++k) {
    if (k > 0 && lines[k] == lines[k - 1]) continue;
    // Multiplicative hashing by the golden ratio (Knuth, The Art of Computer Programming 3, 6.4).
    std::size_t place = (lines[k] * 0x9E3779B97F4A7C15u) >> 57;
    while (table[place] != kFree && lines[map.first[table[place]]] != lines[k]) place = (place + 1) % kPlaces;
    const bool is_new = table[place] == kFree;
    if (is_new) {
      map.first[map.different] = static_cast<std::uint8_t>(k);
      table[place] = static_cast<std::uint8_t>(map.different++);
    } else {
      map.old[map.olds++] = table[place];
    }
    if (k == 0) continue;
    map.changed |= std::uint64_t{1} << (k - 1);
    map.is_new |= std::uint64_t{is_new} << changes++;
  }
  return map;
}

void write_map(const LineMap& map, BitWriter& writer) {
  if (map.different == kTileSize) return;
  writer.write(map.changed, kChangeBits);
  writer.write(map.is_new, map.changes());
  for (unsigned k = 0; k < map.olds; ++k) writer.write(map.old[k], map.index_bits());
}

/// How the 64 lines follow from the different ones.
struct LineOrder {
  std::uint64_t changed = low_bits(kChangeBits);  ///< bit k: line k + 1 differs from line k
  std::array<std::uint8_t, kTileSize> of_change;  ///< the different line that stands there after each change
  bool valid = true;
};

LineOrder read_order(unsigned different, BitReader& reader) {
  LineOrder order;
  if (different == kTileSize) {
    for (std::size_t k = 0; k < kTileSize; ++k) order.of_change[k] = static_cast<std::uint8_t>(k);
    return order;
  }
  order.changed &= reader.peek();
  reader.skip(kChangeBits);
  std::uint64_t is_new = reader.peek();
  const auto changes = static_cast<unsigned>(std::popcount(order.changed));
  reader.skip(changes);

  const auto index_bits = static_cast<unsigned>(std::bit_width(different - 1));
  const std::uint64_t index_mask = (std::uint64_t{1} << index_bits) - 1;
  order.of_change[0] = 0;
  unsigned seen = 1;
  // Without branches, by masks, since what comes next is hard to predict.
  for (unsigned k = 1; k <= changes; ++k, is_new >>= 1) {
    const unsigned first_seen = is_new & 1;
    const unsigned is_old = first_seen - 1;  // all bits, or none
    const unsigned index = (static_cast<unsigned>(reader.peek() & index_mask) & is_old) | (seen & ~is_old);
    order.of_change[k] = static_cast<std::uint8_t>(index);
    order.valid &= index < seen + first_seen;
    seen += first_seen;
    reader.skip(index_bits & is_old);
  }
  order.valid &= seen == different;
  return order;
}

/// All 64 lines.
void expand(const LineOrder& order, const TileBits& different, TileBits& lines) {
  TileBits after_change;
  const auto changes = static_cast<std::size_t>(std::popcount(order.changed));
  for (std::size_t k = 0; k <= changes; ++k) after_change[k] = different[order.of_change[k]];
  const std::uint64_t* line = after_change.data();
  for (std::size_t k = 0; k < kTileSize; ++k) {
    lines[k] = *line;
    line += order.changed >> k & 1;
  }
}

unsigned read_count(BitReader& reader) {
  const auto count = static_cast<unsigned>(reader.peek() & low_bits(kCountBits)) + 1;
  reader.skip(kCountBits);
  return count;
}

TileBits transposed_rows(const TileBits& bits, const LineMap& rows) {
  TileBits different{};
  for (unsigned k = 0; k < rows.different; ++k) different[k] = bits[rows.first[k]];
  transpose(different);
  return different;
}

}  // namespace

TileCode encode_tile(const TileBits& bits) {
  LineMap rows = find_alike(bits);
  TileBits by_columns = transposed_rows(bits, rows);
  LineMap columns = find_alike(by_columns);
  if (rows.bits() + columns.bits() + rows.different * columns.different >= kTileSize * kTileSize) {
    rows = columns = all_different();
    by_columns = transposed_rows(bits, rows);
  }
  TileCode code;
  BitWriter writer(code.bytes.data());
  writer.write(rows.different - 1, kCountBits);
  writer.write(columns.different - 1, kCountBits);
  write_map(rows, writer);
  write_map(columns, writer);
  for (unsigned k = 0; k < columns.different; ++k) writer.write(by_columns[columns.first[k]], rows.different);
  code.size = writer.bytes();
  return code;
}

void decode_tile(const std::byte* code, TileBits& bits) {
  BitReader reader(code);
  const unsigned rows = read_count(reader);
  const unsigned columns = read_count(reader);
  const LineOrder row_order = read_order(rows, reader);
  const LineOrder column_order = read_order(columns, reader);
  // A word has other bits beyond its own; they end up in rows that stand nowhere.
  TileBits different;
  for (unsigned k = 0; k < columns; ++k) {
    different[k] = reader.peek();
    reader.skip(rows);
  }
  TileBits all_columns;
  expand(column_order, different, all_columns);
  transpose(all_columns, rows);
  expand(row_order, all_columns, bits);
}

std::size_t checked_code_size(std::span<const std::byte> bytes) {
  // The longest counts and maps; what is missing reads as 0.
  constexpr std::size_t kMaxBits = 2 * (kCountBits + kChangeBits * (2 + kCountBits));
  std::array<std::byte, kMaxBits / 8 + 1 + 2 * TileCode::kPadding> head{};
  std::copy_n(bytes.begin(), std::min(bytes.size(), head.size()), head.begin());
  BitReader reader(head.data());
  const unsigned rows = read_count(reader);
  const unsigned columns = read_count(reader);
  const bool valid = read_order(rows, reader).valid && read_order(columns, reader).valid;
  const std::size_t size = (reader.position() + rows * columns + 7) / 8;
  if (!valid || size > std::min(bytes.size(), TileCode::kMaxBytes))
    throw std::runtime_error("the code of a visibility tile is damaged");
  return size;
}

}  // namespace fluxel
