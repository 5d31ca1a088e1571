#include "output/elements/glb_writer.hpp"

#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/file.hpp"

namespace fluxel {

namespace {

using nlohmann::json;

static_assert(std::endian::native == std::endian::little, "the file is little endian");

/// Constants of glTF.
constexpr int kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126, kVertices = 34962, kIndices = 34963;

/// A quarter turn about x, which makes z y: a quaternion.
const json kZToY = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};

constexpr float kWhite = 65535;  // of a colour's channel

template <class T>
void append_value(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

/// The file's buffer, and what its parts are.
class Buffer {
 public:
  /// Adds values that lie one after the other, and returns the number of their accessor.
  template <class T>
  std::size_t add(const std::vector<T>& values, int target, json accessor) {
    views_.push_back({{"buffer", 0},
                      {"byteOffset", bytes_.size()},
                      {"byteLength", values.size() * sizeof(T)},
                      {"target", target}});
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    accessor["bufferView"] = views_.size() - 1;
    accessor["count"] = values.size();
    accessors_.push_back(std::move(accessor));
    return accessors_.size() - 1;
  }
  void describe(json& document) const {
    document["buffers"] = json::array({{{"byteLength", bytes_.size()}}});
    document["bufferViews"] = views_;
    document["accessors"] = accessors_;
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  json views_ = json::array(), accessors_ = json::array();
};

json vector_json(const glm::vec3& v) { return {v.x, v.y, v.z}; }

std::size_t add_positions(const GlbPart& part, Buffer& buffer) {
  glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
  for (const glm::vec3& position : part.positions)
    low = glm::min(low, position), high = glm::max(high, position);
  return buffer.add(
      part.positions, kVertices,
      {{"componentType", kFloat}, {"type", "VEC3"}, {"min", vector_json(low)}, {"max", vector_json(high)}});
}

std::size_t add_colours(const GlbPart& part, Buffer& buffer) {
  std::vector<std::array<std::uint16_t, 4>> colours;  // a multiple of four bytes each, as the format wants
  colours.reserve(part.colours.size());
  for (const Rgb& colour : part.colours) {
    const auto channel = [&](int c) {
      return static_cast<std::uint16_t>(
          std::lround(kWhite * std::min(std::max(static_cast<float>(colour[c]), 0.0F), 1.0F)));
    };
    colours.push_back({channel(0), channel(1), channel(2), 65535});
  }
  return buffer.add(colours, kVertices,
                    {{"componentType", kUnsignedShort}, {"type", "VEC4"}, {"normalized", true}});
}

std::size_t add_radiosity(const GlbPart& part, Buffer& buffer) {
  std::vector<glm::vec3> radiosity(part.radiosity.begin(), part.radiosity.end());
  return buffer.add(radiosity, kVertices, {{"componentType", kFloat}, {"type", "VEC3"}});
}

}  // namespace

void write_glb(const std::filesystem::path& file, std::span<const GlbPart> parts, const glm::dvec3& origin,
               bool z_up, const std::string& generator) {
  Buffer buffer;
  json nodes = json::array(), meshes = json::array(), children = json::array();
  nodes.push_back({{"name", "fluxel"}});
  for (const GlbPart& part : parts) {
    if (part.corners.empty()) continue;
    const json attributes{{"POSITION", add_positions(part, buffer)},
                          {"COLOR_0", add_colours(part, buffer)},
                          {"_RADIOSITY", add_radiosity(part, buffer)}};
    const std::size_t indices =
        buffer.add(part.corners, kIndices, {{"componentType", kUnsignedInt}, {"type", "SCALAR"}});
    children.push_back(nodes.size());
    nodes.push_back({{"name", part.name}, {"mesh", meshes.size()}});
    meshes.push_back(
        {{"name", part.name},
         {"primitives", json::array({{{"attributes", attributes}, {"indices", indices}, {"material", 0}}})}});
  }
  json& root = nodes.front();
  root["children"] = children;
  // The root is moved after it is turned.
  const glm::dvec3 at = z_up ? glm::dvec3(origin.x, origin.z, -origin.y) : origin;
  root["translation"] = {at.x, at.y, at.z};
  if (z_up) root["rotation"] = kZToY;
  json document{
      {"asset", {{"version", "2.0"}, {"generator", generator}}},
      {"scene", 0},
      {"scenes", json::array({{{"nodes", {0}}}})},
      {"nodes", nodes},
      {"meshes", meshes},
      {"extensionsUsed", {"KHR_materials_unlit"}},
      {"materials", json::array({{{"name", "radiosity"},
                                  {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}},
                                  {"extensions", {{"KHR_materials_unlit", json::object()}}}}})}};
  buffer.describe(document);

  std::string text = document.dump(-1, ' ', false, json::error_handler_t::replace), data = buffer.bytes();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  data.resize((data.size() + 3) / 4 * 4, '\0');
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
