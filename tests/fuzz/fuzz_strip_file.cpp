// The bytes of a file of strips; and, since no check sum stands there, of tiles as they are sent and kept.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>

#include "visibility/strip_file.hpp"
#include "visibility/tile_code.hpp"

namespace {

/// Code with room behind it is decoded.
void decode(const fluxel::TileView& tile) {
  fluxel::TileCode code;
  if (tile.code.size() > fluxel::TileCode::kMaxBytes) std::abort();
  std::copy(tile.code.begin(), tile.code.end(), code.bytes.begin());
  fluxel::TileBits bits;
  if (tile.tag == fluxel::TileTag::bits) fluxel::decode_tile(code.bytes.data(), bits);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // 100 tiles a side.
  constexpr fluxel::StripFileKey kKey{0x1234, 6400};
  std::istringstream stream(std::string(reinterpret_cast<const char*>(data), size), std::ios::binary);
  static_cast<void>(
      fluxel::read_strip_file(stream, kKey, [](std::uint64_t number, const fluxel::TileView& tile) {
        if (number >= 5050) std::abort();
        decode(tile);
      }));

  std::span<const std::byte> rest = std::as_bytes(std::span(data, size));
  try {
    while (!rest.empty()) decode(fluxel::take_tile(rest));
  } catch (const std::runtime_error&) {  // how bad tiles are to be told
  }
  return 0;
}
