#include "visibility/tile_store.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>

namespace fluxel {

namespace {

constexpr std::uint32_t kAbsent = 3;
constexpr std::uint32_t kFirstPlace = 4;

// A table's entry counts units. A chunk is large beside a code, because none goes on in the next, and small
// beside the codes of all but tiny scenes, because the last one is half empty.
constexpr std::size_t kUnit = 4;
constexpr std::size_t kChunk = 16384;
constexpr std::size_t kMaxPoolBytes = (TileCode::kMaxBytes + kUnit - 1) / kUnit * kUnit;

constexpr std::size_t kBytesPerChunk = kChunk + TileCode::kPadding + sizeof(std::unique_ptr<std::byte[]>);

std::size_t chunks_for(std::size_t bytes, std::size_t in_each) { return (bytes + in_each - 1) / in_each; }

}  // namespace

TileStore::TileStore(std::size_t tiles, TileRows owned)
    : tiles_(tiles), owned_(owned), entries_(owned.size() * tiles, kAbsent), used_(kChunk) {}

std::size_t TileStore::index_of(std::size_t row, std::size_t column) const {
  if (row > column) std::swap(row, column);
  // A tile of two owned rows stands with the lower one.
  if (!owned_.contains(row)) std::swap(row, column);
  if (!owned_.contains(row) || column >= tiles_)
    throw std::logic_error("a visibility tile does not belong to this rank");
  return (row - owned_.first) * tiles_ + column;
}

void TileStore::put(std::size_t row, std::size_t column, TileTag tag, std::span<const std::byte> code) {
  std::uint32_t& entry = entries_[index_of(row, column)];
  if (entry != kAbsent) throw std::logic_error("a visibility tile came twice");
  if (tag == TileTag::bits) {
    const std::size_t size = pool_bytes(code.size());
    const bool fits = used_ + size <= kChunk;
    const std::size_t first = fits ? used_ : 0;
    const std::size_t chunk = fits ? pool_.size() - 1 : pool_.size();
    const std::uint32_t place = place_of((chunk * kChunk + first) / kUnit);
    if (!fits) pool_.push_back(std::make_unique_for_overwrite<std::byte[]>(kChunk + TileCode::kPadding));
    std::memcpy(pool_.back().get() + first, code.data(), code.size());
    used_ = first + size;
    entry = place;
    ++mixed_;
  } else {
    entry = static_cast<std::uint32_t>(tag);
  }
  ++held_;
}

void TileStore::put(std::size_t row, std::size_t column, TileTag tag, const TileBits& bits) {
  const TileCode code = tag == TileTag::bits ? encode_tile(bits) : TileCode{};
  put(row, column, tag, code.view());
}

bool TileStore::has(std::size_t row, std::size_t column) const {
  return entries_[index_of(row, column)] != kAbsent;
}

TileTag TileStore::tag(std::size_t row, std::size_t column) const {
  const std::uint32_t entry = entries_[index_of(row, column)];
  if (entry == kAbsent) throw std::logic_error("a visibility tile is missing");
  return entry >= kFirstPlace ? TileTag::bits : static_cast<TileTag>(entry);
}

/// The pool from a code on to the end of its chunk, padding included.
std::span<const std::byte> TileStore::from(std::uint32_t place) const {
  const std::size_t at = (place - kFirstPlace) * kUnit;
  return std::span(pool_[at / kChunk].get(), kChunk + TileCode::kPadding).subspan(at % kChunk);
}

TileView TileStore::view(std::size_t row, std::size_t column) const {
  const TileTag its_tag = tag(row, column);
  if (its_tag != TileTag::bits) return {its_tag, {}};
  const auto code = from(entries_[index_of(row, column)]);
  return {its_tag, code.first(checked_code_size(code))};
}

void TileStore::read(std::size_t row, std::size_t column, TileBits& bits) const {
  const std::uint32_t entry = entries_[index_of(row, column)];
  if (entry == kAbsent) throw std::logic_error("a visibility tile is missing");
  if (entry >= kFirstPlace) {
    decode_tile(from(entry).data(), bits);
    // A tile on the diagonal is symmetric.
    if (row > column) transpose(bits);
  } else {
    bits.fill(entry == static_cast<std::uint32_t>(TileTag::visible) ? ~std::uint64_t{0} : 0);
  }
}

std::size_t TileStore::expected_for(std::size_t tiles, const TileRows& owned) {
  const std::size_t both = owned.size() * (owned.size() + 1) / 2;
  return both + owned.size() * (tiles - owned.size());
}

std::size_t TileStore::bytes() const { return bytes_for(tiles_, owned_, pool_.size() * kChunk); }

std::uint32_t TileStore::place_of(std::size_t unit) {
  if (unit > std::numeric_limits<std::uint32_t>::max() - kFirstPlace)
    throw std::length_error("too many visibility tiles with bits on one rank: use more ranks");
  return kFirstPlace + static_cast<std::uint32_t>(unit);
}

std::size_t TileStore::pool_bytes(std::size_t size) { return (size + kUnit - 1) / kUnit * kUnit; }

std::size_t TileStore::bytes_for(std::size_t tiles, const TileRows& owned, std::size_t pool_bytes) {
  return owned.size() * tiles * sizeof(std::uint32_t) + chunks_for(pool_bytes, kChunk) * kBytesPerChunk;
}

std::size_t TileStore::max_bytes(std::size_t count) {
  // Whatever the order of codes, less than one of them is left over at the end of a full chunk.
  return chunks_for(count * kMaxPoolBytes, kChunk - kMaxPoolBytes) * kBytesPerChunk;
}

}  // namespace fluxel
