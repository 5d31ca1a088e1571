#include "mpi_master/tile_messages.hpp"

#include <cstring>
#include <stdexcept>

namespace fluxel {

namespace {

struct Header {
  std::uint64_t row, first_column, count;
};

template <class T>
void append(Bytes& bytes, const T& object) {
  bytes.resize(bytes.size() + sizeof(T));
  std::memcpy(bytes.data() + bytes.size() - sizeof(T), &object, sizeof(T));
}

template <class T>
T take_front(std::span<const std::byte>& bytes) {
  if (bytes.size() < sizeof(T)) throw std::runtime_error("a message of visibility tiles is too short");
  T object;
  std::memcpy(&object, bytes.data(), sizeof(T));
  bytes = bytes.subspan(sizeof(T));
  return object;
}

}  // namespace

Bytes encode_tiles(std::size_t row, std::size_t first_column, std::span<const TracedTile> tiles) {
  Bytes bytes;
  append(bytes, Header{row, first_column, tiles.size()});
  for (const TracedTile& tile : tiles) {
    append(bytes, tile.tag);
    if (tile.tag == TileTag::bits) append(bytes, tile.bits);
  }
  return bytes;
}

void decode_tiles(const Bytes& bytes,
                  const std::function<void(std::size_t, std::size_t, TileTag, const TileBits&)>& take) {
  std::span<const std::byte> rest(bytes);
  const auto header = take_front<Header>(rest);
  for (std::uint64_t k = 0; k < header.count; ++k) {
    const auto tag = take_front<TileTag>(rest);
    if (tag > TileTag::bits) throw std::runtime_error("a message of visibility tiles has an unknown tag");
    take(header.row, header.first_column + k, tag,
         tag == TileTag::bits ? take_front<TileBits>(rest) : TileBits{});
  }
  if (!rest.empty()) throw std::runtime_error("a message of visibility tiles is too long");
}

}  // namespace fluxel
