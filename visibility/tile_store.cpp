#include "visibility/tile_store.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace fluxel {

namespace {

constexpr std::uint32_t kAbsent = 3;
constexpr std::uint32_t kFirstSlot = 4;

}  // namespace

TileStore::TileStore(std::size_t tiles, TileRows owned)
    : tiles_(tiles), owned_(owned), entries_(owned.size() * tiles, kAbsent) {}

std::uint32_t TileStore::entry(std::size_t row, std::size_t column) const {
  if (row > column) std::swap(row, column);
  // A tile of two owned rows stands with the lower one.
  if (owned_.contains(row)) return entries_[(row - owned_.first) * tiles_ + column];
  return entries_.at((column - owned_.first) * tiles_ + row);
}

std::uint32_t& TileStore::entry(std::size_t row, std::size_t column) {
  if (owned_.contains(row)) return entries_[(row - owned_.first) * tiles_ + column];
  return entries_.at((column - owned_.first) * tiles_ + row);
}

void TileStore::put(std::size_t row, std::size_t column, TileTag tag, const TileBits& bits) {
  std::uint32_t& place = entry(row, column);
  if (place != kAbsent) throw std::logic_error("a visibility tile came twice");
  if (tag == TileTag::bits) {
    const std::uint32_t slot = slot_of(mixed_);
    if (mixed_ % kChunk == 0) pool_.push_back(std::make_unique_for_overwrite<TileBits[]>(kChunk));
    pool_.back()[mixed_ % kChunk] = bits;
    place = slot;
    ++mixed_;
  } else {
    place = static_cast<std::uint32_t>(tag);
  }
  ++held_;
}

TileTag TileStore::tag(std::size_t row, std::size_t column) const {
  const std::uint32_t value = entry(row, column);
  if (value == kAbsent) throw std::logic_error("a visibility tile is missing");
  return value >= kFirstSlot ? TileTag::bits : static_cast<TileTag>(value);
}

void TileStore::read(std::size_t row, std::size_t column, TileBits& bits) const {
  const std::uint32_t value = entry(row, column);
  if (value == kAbsent) throw std::logic_error("a visibility tile is missing");
  if (value >= kFirstSlot) {
    const std::size_t slot = value - kFirstSlot;
    bits = pool_[slot / kChunk][slot % kChunk];
    // A tile on the diagonal is symmetric.
    if (row > column) transpose(bits);
  } else {
    bits.fill(value == static_cast<std::uint32_t>(TileTag::visible) ? ~std::uint64_t{0} : 0);
  }
}

std::size_t TileStore::expected() const {
  const std::size_t both = owned_.size() * (owned_.size() + 1) / 2;
  return both + owned_.size() * (tiles_ - owned_.size());
}

std::size_t TileStore::bytes() const { return bytes_for(tiles_, owned_, mixed_); }

std::uint32_t TileStore::slot_of(std::size_t mixed) {
  if (mixed > std::numeric_limits<std::uint32_t>::max() - kFirstSlot)
    throw std::length_error("too many visibility tiles with bits on one rank: use more ranks");
  return kFirstSlot + static_cast<std::uint32_t>(mixed);
}

std::size_t TileStore::bytes_for(std::size_t tiles, const TileRows& owned, std::size_t mixed) {
  const std::size_t chunks = (mixed + kChunk - 1) / kChunk;
  return owned.size() * tiles * sizeof(std::uint32_t) + chunks * kChunk * sizeof(TileBits);
}

}  // namespace fluxel
