#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/options.hpp"
#include "scene/readers/gltf_reader.hpp"

namespace fluxel::gltf_files {

using nlohmann::json;
using Files = std::map<std::string, std::string>;  // by path, beside "dir/a.gltf"

/// Values as they stand in a buffer, little-endian.
template <class Value>
std::string bytes_of(const std::vector<Value>& values) {
  static_assert(std::endian::native == std::endian::little);
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

inline std::string base64(const std::string& bytes) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 3; ++i)
      bits = bits << 8 | (k + i < bytes.size() ? static_cast<unsigned char>(bytes[k + i]) : 0u);
    for (std::size_t i = 0; i < 4; ++i)
      text += k + i > bytes.size() ? '=' : digits[bits >> (18 - 6 * i) & 63u];
  }
  return text;
}

inline std::string data_uri(const std::string& bytes) {
  return "data:application/octet-stream;base64," + base64(bytes);
}

/// A chunk of a GLB, padded to four bytes.
inline std::string chunk(std::uint32_t type, std::string bytes) {
  while (bytes.size() % 4 != 0) bytes.push_back(type == 0x4E4F534A ? ' ' : '\0');
  return bytes_of<std::uint32_t>({static_cast<std::uint32_t>(bytes.size()), type}) + bytes;
}

inline std::string glb(const json& document, const std::string& buffer) {
  const std::string chunks = chunk(0x4E4F534A, document.dump()) + chunk(0x004E4942, buffer);
  return "glTF" + bytes_of<std::uint32_t>({2, static_cast<std::uint32_t>(chunks.size() + 12)}) + chunks;
}

/// Appends bytes to the buffer of a document, as a view of their own; its index.
inline std::size_t add_view(json& document, std::string& buffer, const std::string& bytes) {
  while (buffer.size() % 4 != 0) buffer.push_back('\0');
  document["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", bytes.size()}});
  buffer += bytes;
  document["buffers"][0]["byteLength"] = buffer.size();
  return document["bufferViews"].size() - 1;
}

/// Appends an accessor of a view of its own; its index.
inline std::size_t add_accessor(json& document, std::string& buffer, const std::string& bytes,
                                int component_type, const char* type, std::size_t count) {
  const std::size_t view = add_view(document, buffer, bytes);
  document["accessors"].push_back(
      {{"bufferView", view}, {"componentType", component_type}, {"type", type}, {"count", count}});
  return document["accessors"].size() - 1;
}

/// One triangle (0,0,0) (1,0,0) (0,1,0): accessors[0] its positions, accessors[1] its indices.
struct Triangle {
  json document = json::parse(R"({"asset": {"version": "2.0"}, "nodes": [{"name": "leaf", "mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}]})");
  std::string buffer;

  Triangle() {
    add_accessor(document, buffer, bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}), 5126, "VEC3", 3);
    add_accessor(document, buffer, bytes_of<std::uint16_t>({0, 1, 2}), 5123, "SCALAR", 3);
  }

  json& operator[](const std::string& pointer) { return document[json::json_pointer(pointer)]; }
  [[nodiscard]] json& primitive() { return document["meshes"][0]["primitives"][0]; }
  /// With its buffer within.
  [[nodiscard]] std::string text() const {
    json whole = document;
    if (!whole["buffers"][0].contains("uri")) whole["buffers"][0]["uri"] = data_uri(buffer);
    return whole.dump();
  }
};

inline SceneInput read(const std::string& bytes, const Files& files = {}) {
  return read_gltf("dir/a.gltf", bytes, [&](const std::filesystem::path& path) {
    const auto found = files.find(path.string());
    return found == files.end() ? std::nullopt : std::optional(found->second);
  });
}

inline std::string error_of(const std::string& bytes, const Files& files = {}) {
  try {
    static_cast<void>(read(bytes, files));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace fluxel::gltf_files
