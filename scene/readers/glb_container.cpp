#include "scene/readers/glb_container.hpp"

#include <fmt/format.h>

#include <cstdint>

#include "core/input_error_at.hpp"

namespace fluxel {
namespace {

constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;  // "JSON", "BIN\0"

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t k = 4; k-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
  return value;
}

/// Gives the chunks of a GLB one by one.
class Chunks {
 public:
  Chunks(const std::filesystem::path& file, std::string_view bytes) : file_(file), bytes_(bytes) {}

  struct Chunk {
    std::uint32_t type;
    std::string_view data;
    std::size_t at;  ///< byte where the data begin
  };

  std::optional<Chunk> next() {
    if (at_ == bytes_.size()) return std::nullopt;
    if (bytes_.size() - at_ < kChunkHeaderBytes) throw error("a chunk header is cut off");
    const std::uint32_t length = little_endian(bytes_, at_);
    const std::size_t data = at_ + kChunkHeaderBytes;
    if (length > bytes_.size() - data) {
      throw error(fmt::format("a chunk of {} bytes is cut off: {} are left", length, bytes_.size() - data));
    }
    const Chunk chunk{little_endian(bytes_, at_ + 4), bytes_.substr(data, length), data};
    at_ = data + length;
    return chunk;
  }

 private:
  [[nodiscard]] InputError error(const std::string& what) const {
    return input_error_at(file_, 0, fmt::format("byte {}: {}", at_, what), "the file is damaged");
  }

  const std::filesystem::path& file_;
  std::string_view bytes_;
  std::size_t at_ = kHeaderBytes;
};

}  // namespace

GltfParts split_gltf(const std::filesystem::path& file, const std::string& bytes) {
  if (!bytes.starts_with("glTF")) return {.json = bytes};
  if (bytes.size() < kHeaderBytes) throw input_error_at(file, 0, "the header of the GLB is cut off");
  const std::uint32_t version = little_endian(bytes, 4), length = little_endian(bytes, 8);
  if (version != 2) {
    throw input_error_at(file, 0, fmt::format("byte 4: version {} of GLB", version), "only 2 is read");
  }
  if (length < kHeaderBytes || length > bytes.size()) {
    throw input_error_at(
        file, 0, fmt::format("byte 8: the GLB says to have {} bytes and has {}", length, bytes.size()),
        "the file is damaged");
  }
  Chunks chunks(file, std::string_view(bytes).substr(0, length));
  const std::optional<Chunks::Chunk> json = chunks.next();
  if (!json || json->type != kJsonChunk)
    throw input_error_at(file, 0, "the first chunk of the GLB is not JSON", "the file is damaged");
  GltfParts parts{.json = json->data, .json_at = json->at};
  for (std::optional<Chunks::Chunk> chunk = chunks.next(); chunk; chunk = chunks.next()) {
    if (chunk->type == kBinaryChunk && !parts.binary) parts.binary = chunk->data;
  }
  return parts;
}

}  // namespace fluxel
