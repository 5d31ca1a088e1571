#include "mpi_master/tile_messages.hpp"

#include <cstring>
#include <stdexcept>

namespace fluxel {

namespace {

struct Header {
  std::uint64_t row, first_column, count;
};

void append(Bytes& bytes, std::span<const std::byte> more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
}

std::span<const std::byte> take_front(std::span<const std::byte>& bytes, std::size_t size) {
  if (bytes.size() < size) throw std::runtime_error("a message of visibility tiles is too short");
  const auto front = bytes.first(size);
  bytes = bytes.subspan(size);
  return front;
}

template <class T>
T take_front(std::span<const std::byte>& bytes) {
  T object;
  std::memcpy(&object, take_front(bytes, sizeof(T)).data(), sizeof(T));
  return object;
}

}  // namespace

void append_tiles(Bytes& message, std::size_t row, std::size_t first_column,
                  std::span<const CodedTile> tiles) {
  const Header header{row, first_column, tiles.size()};
  append(message, std::as_bytes(std::span(&header, 1)));
  for (const CodedTile& tile : tiles) {
    message.push_back(static_cast<std::byte>(tile.tag));
    if (tile.tag == TileTag::bits) append(message, tile.code.view());
  }
}

void decode_tiles(
    const Bytes& message,
    const std::function<void(std::size_t, std::size_t, TileTag, std::span<const std::byte>)>& take) {
  std::span<const std::byte> rest(message);
  while (!rest.empty()) {
    const auto header = take_front<Header>(rest);
    for (std::uint64_t k = 0; k < header.count; ++k) {
      const auto tag = take_front<TileTag>(rest);
      if (tag > TileTag::bits) throw std::runtime_error("a message of visibility tiles has an unknown tag");
      const std::size_t size = tag == TileTag::bits ? checked_code_size(rest) : 0;
      take(header.row, header.first_column + k, tag, take_front(rest, size));
    }
  }
}

}  // namespace fluxel
