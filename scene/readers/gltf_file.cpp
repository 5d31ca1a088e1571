#include "scene/readers/gltf_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>  // the parser uses it
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "scene/readers/gltf_uri.hpp"

// The parser, compiled here: of JSON alone, which has been checked.
#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>

namespace fluxel {
namespace {

std::shared_ptr<const tinygltf::Model> parse_model(const std::filesystem::path& file,
                                                   const std::string& json) {
  if (json.size() > std::numeric_limits<unsigned>::max())
    throw input_error_at(file, 0, "the JSON is too long");
  auto model = std::make_shared<tinygltf::Model>();
  std::string error, warning;
  bool read = false;
  try {
    read = tinygltf::TinyGLTF().LoadASCIIFromString(model.get(), &error, &warning, json.data(),
                                                    static_cast<unsigned>(json.size()), {});
  } catch (const std::exception& failure) {
    error = failure.what();
  }
  if (!read || !error.empty()) {
    throw input_error_at(file, 0,
                         "not glTF: " + error.substr(0, std::min<std::size_t>(error.find('\n'), 200)));
  }
  return model;
}

void read_buffers(GltfFile& gltf, std::optional<std::string_view> binary, const TextLookup& lookup) {
  for (std::size_t k = 0; k < gltf.document.buffers.size(); ++k) {
    const auto& [uri, view, byte_length] = gltf.document.buffers[k];
    const std::string where = gltf_element("buffers", k);
    std::string_view bytes;
    if (uri) {
      const auto [entry, added] = gltf.read.try_emplace(*uri);
      if (added) entry->second = read_gltf_uri(gltf.path, where + ".uri", *uri, lookup);
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
  gltf.document = check_gltf(file, parts);
  gltf.model = parse_model(file, std::exchange(gltf.document.json, {}));
  read_buffers(gltf, parts.binary, lookup);
  return gltf;
}

std::string_view buffer_view_bytes(const GltfFile& gltf, std::size_t view) {
  const tinygltf::BufferView& given = gltf.model->bufferViews[view];
  const std::string_view buffer = gltf.buffers[static_cast<std::size_t>(given.buffer)];
  if (given.byteOffset > buffer.size() || given.byteLength > buffer.size() - given.byteOffset) {
    throw gltf.error(gltf_element("bufferViews", view),
                     fmt::format("{} bytes from byte {} on reach beyond buffers[{}]", given.byteLength,
                                 given.byteOffset, given.buffer),
                     fmt::format("it has {} bytes", buffer.size()));
  }
  return buffer.substr(given.byteOffset, given.byteLength);
}

}  // namespace fluxel
