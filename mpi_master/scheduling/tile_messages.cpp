#include "mpi_master/scheduling/tile_messages.hpp"

#include <cstring>
#include <stdexcept>

#include "visibility/coded_tile.hpp"

namespace fluxel {

namespace {

struct Header {
  std::uint64_t row, first_column, count;
};

Header take_header(std::span<const std::byte>& bytes) {
  Header header;
  if (bytes.size() < sizeof header) throw std::runtime_error("a message of visibility tiles is too short");
  std::memcpy(&header, bytes.data(), sizeof header);
  bytes = bytes.subspan(sizeof header);
  return header;
}

}  // namespace

void append_tiles(Bytes& message, std::size_t row, std::size_t first_column,
                  std::span<const CodedTile> tiles) {
  const Header header{row, first_column, tiles.size()};
  const auto bytes = std::as_bytes(std::span(&header, 1));
  message.insert(message.end(), bytes.begin(), bytes.end());
  for (const CodedTile& tile : tiles) append_tile(message, {tile.tag, tile.code.view()});
}

void decode_tiles(
    const Bytes& message,
    const std::function<void(std::size_t, std::size_t, TileTag, std::span<const std::byte>)>& take) {
  std::span<const std::byte> rest(message);
  while (!rest.empty()) {
    const Header header = take_header(rest);
    for (std::uint64_t k = 0; k < header.count; ++k) {
      const TileView tile = take_tile(rest);
      take(header.row, header.first_column + k, tile.tag, tile.code);
    }
  }
}

}  // namespace fluxel
