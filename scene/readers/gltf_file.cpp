#include "scene/readers/gltf_file.hpp"

#include <fmt/format.h>

#include <optional>

#include "scene/readers/gltf_document.hpp"
#include "scene/readers/gltf_uri.hpp"

namespace fluxel {
namespace {

void read_buffers(GltfFile& gltf, std::optional<std::string_view> binary, const TextLookup& lookup) {
  const GltfValue buffers = gltf["buffers"];
  for (std::size_t k = 0; k < buffers.size(); ++k) {
    const GltfValue uri = buffers[k]["uri"];
    const std::size_t byte_length = buffers[k]["byteLength"].whole();
    const std::string where = gltf_element("buffers", k);
    std::string_view bytes;
    if (uri.given()) {
      const auto [entry, added] = gltf.read.try_emplace(uri.text());
      if (added) entry->second = read_gltf_uri(gltf.path, where + ".uri", uri.text(), lookup);
      bytes = entry->second;
    } else if (k == 0 && binary) {
      bytes = *binary;
    } else {
      throw gltf.error(where, "has no uri", "only the first buffer of a GLB may lack it");
    }
    if (byte_length > bytes.size()) {
      throw gltf.error(where + ".byteLength",
                       fmt::format("{} bytes, but there are {}", byte_length, bytes.size()),
                       "is a file cut off?");
    }
    gltf.buffers.push_back(bytes.substr(0, byte_length));
  }
}

}  // namespace

std::string gltf_element(const char* array, std::size_t element) {
  return fmt::format("{}[{}]", array, element);
}

GltfFile open_gltf(const std::filesystem::path& file, const std::string& bytes, const TextLookup& lookup) {
  const GltfParts parts = split_gltf(file, bytes);
  GltfFile gltf;
  gltf.path = file;
  gltf.document = parse_gltf(file, parts);
  read_buffers(gltf, parts.binary, lookup);
  return gltf;
}

std::string_view buffer_view_bytes(const GltfFile& gltf, std::size_t view) {
  const GltfValue given = gltf["bufferViews"][view];
  const std::size_t buffer = given["buffer"].whole();
  const std::size_t offset = given["byteOffset"].whole(), length = given["byteLength"].whole();
  const std::string_view bytes = gltf.buffers[buffer];
  if (offset > bytes.size() || length > bytes.size() - offset) {
    throw gltf.error(gltf_element("bufferViews", view),
                     fmt::format("{} bytes from byte {} on reach beyond buffers[{}]", length, offset, buffer),
                     fmt::format("it has {} bytes", bytes.size()));
  }
  return bytes.substr(offset, length);
}

}  // namespace fluxel
