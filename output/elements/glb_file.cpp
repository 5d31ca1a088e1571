#include "output/elements/glb_file.hpp"

#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <utility>

#include "core/file.hpp"
#include "core/input_error_at.hpp"

namespace fluxel {

namespace {

using nlohmann::json;

static_assert(std::endian::native == std::endian::little, "the file is little endian");

/// A quarter turn about x, which makes z y: a quaternion.
const json kZToY = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};

/// Parts of the file begin at multiples of that.
constexpr std::size_t kAligned = 4;

template <class T>
void append_value(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

void align(std::string& bytes, char with) {
  bytes.resize((bytes.size() + kAligned - 1) / kAligned * kAligned, with);
}

}  // namespace

std::size_t GlbBuffer::add_bytes(std::string_view bytes) {
  views_.push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}});
  bytes_ += bytes;
  align(bytes_, '\0');
  return views_.size() - 1;
}

std::size_t GlbBuffer::add_positions(const std::vector<glm::vec3>& positions) {
  glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
  for (const glm::vec3& position : positions) low = glm::min(low, position), high = glm::max(high, position);
  return add(positions, kGltfVertices,
             {{"componentType", kGltfFloat},
              {"type", "VEC3"},
              {"min", vector_json(low)},
              {"max", vector_json(high)}});
}

std::size_t GlbBuffer::add_indices(const std::vector<std::uint32_t>& corners) {
  return add(corners, kGltfIndices, {{"componentType", kGltfUnsignedInt}, {"type", "SCALAR"}});
}

void GlbBuffer::describe(json& document) const {
  document["buffers"] = json::array({{{"byteLength", bytes_.size()}}});
  document["bufferViews"] = views_;
  document["accessors"] = accessors_;
}

json vector_json(const glm::vec3& v) { return {v.x, v.y, v.z}; }

json unlit_material(const std::string& name) {
  return {{"name", name},
          {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}},
          {"extensions", {{"KHR_materials_unlit", json::object()}}}};
}

json document_of(const GlbScene& scene, const json& nodes, const json& meshes, const json& materials) {
  // The root is moved after it is turned.
  const glm::dvec3 at =
      scene.z_up ? glm::dvec3(scene.origin.x, scene.origin.z, -scene.origin.y) : scene.origin;
  json root{{"name", "fluxel"}, {"translation", {at.x, at.y, at.z}}, {"children", json::array()}};
  if (scene.z_up) root["rotation"] = kZToY;
  json all = json::array({std::move(root)});
  for (const json& node : nodes) {
    all[0]["children"].push_back(all.size());
    all.push_back(node);
  }
  json asset{{"version", "2.0"}, {"generator", scene.generator}};
  if (!scene.comment.empty()) asset["extras"] = {{"comment", scene.comment}};
  return {{"asset", std::move(asset)}, {"scene", 0},       {"scenes", json::array({{{"nodes", {0}}}})},
          {"nodes", std::move(all)},   {"meshes", meshes}, {"extensionsUsed", {"KHR_materials_unlit"}},
          {"materials", materials}};
}

void write_glb_file(const std::filesystem::path& file, json document, const GlbBuffer& buffer) {
  buffer.describe(document);
  std::string text = document.dump(-1, ' ', false, json::error_handler_t::replace), data = buffer.bytes();
  align(text, ' ');
  align(data, '\0');
  constexpr std::size_t kHeader = 12, kChunk = 8;
  const std::size_t length = kHeader + kChunk + text.size() + kChunk + data.size();
  if (length > std::numeric_limits<std::uint32_t>::max())
    throw input_error_at(file, 0, "would be longer than the 4 GiB of a GLB",
                         "write solution.vtu in its place");
  std::string bytes = "glTF";
  for (const std::uint32_t number :
       {std::uint32_t{2}, static_cast<std::uint32_t>(length), static_cast<std::uint32_t>(text.size())})
    append_value(bytes, number);
  bytes += "JSON" + text;
  append_value(bytes, static_cast<std::uint32_t>(data.size()));
  bytes += std::string("BIN\0", 4) + data;
  write_bytes_atomically(file, bytes);
}

}  // namespace fluxel
