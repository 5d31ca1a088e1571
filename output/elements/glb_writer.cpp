#include "output/elements/glb_writer.hpp"

#include <algorithm>
#include <array>
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

constexpr float kLargest = 65535;  // of numbers of 16 bits: a colour's channel of 1, the end of a grid

template <class T>
void append_value(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

/// The file's buffer, and what its parts are.
class Buffer {
 public:
  /// Adds values that lie one after the other, with `stride` with a rest behind each, and returns the number
  /// of their accessor.
  template <class T>
  std::size_t add(const std::vector<T>& values, int target, json accessor, bool stride = false) {
    views_.push_back({{"buffer", 0},
                      {"byteOffset", bytes_.size()},
                      {"byteLength", values.size() * sizeof(T)},
                      {"target", target}});
    if (stride) views_.back()["byteStride"] = sizeof(T);
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    bytes_.resize((bytes_.size() + 3) / 4 * 4, '\0');  // where the next ones may begin
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

/// Where quantised positions lie: `low` + `step` times whole numbers.
struct Grid {
  glm::vec3 low{0};
  float step = 1;  // [m]
};

Grid grid_of(std::span<const GlbPart> parts) {
  constexpr float kFar = std::numeric_limits<float>::max();
  glm::vec3 low(kFar), high(-kFar);
  for (const GlbPart& part : parts)
    for (const glm::vec3& position : part.positions)
      low = glm::min(low, position), high = glm::max(high, position);
  const glm::vec3 extent = high - low;
  const float longest = std::max({extent.x, extent.y, extent.z});
  return longest > 0 ? Grid{low, longest / kLargest} : Grid{};
}

json vector_json(const glm::vec3& v) { return {v.x, v.y, v.z}; }

std::size_t add_positions(const GlbPart& part, Buffer& buffer) {
  glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
  for (const glm::vec3& position : part.positions)
    low = glm::min(low, position), high = glm::max(high, position);
  return buffer.add(
      part.positions, kVertices,
      {{"componentType", kFloat}, {"type", "VEC3"}, {"min", vector_json(low)}, {"max", vector_json(high)}});
}

/// Of a multiple of four bytes each, as the format wants: three numbers and a rest.
std::size_t add_quantised_positions(const GlbPart& part, const Grid& grid, Buffer& buffer) {
  std::vector<std::array<std::uint16_t, 4>> positions;
  positions.reserve(part.positions.size());
  std::array<std::uint16_t, 3> low{65535, 65535, 65535}, high{0, 0, 0};
  for (const glm::vec3& position : part.positions) {
    std::array<std::uint16_t, 4>& at = positions.emplace_back();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<glm::length_t>(axis);
      const float steps = std::clamp((position[a] - grid.low[a]) / grid.step, 0.0F, kLargest);
      at[axis] = static_cast<std::uint16_t>(std::lround(steps));
      low[axis] = std::min(low[axis], at[axis]), high[axis] = std::max(high[axis], at[axis]);
    }
  }
  return buffer.add(positions, kVertices,
                    {{"componentType", kUnsignedShort}, {"type", "VEC3"}, {"min", low}, {"max", high}}, true);
}

/// Of 16 bits where these suffice.
std::size_t add_indices(const GlbPart& part, Buffer& buffer) {
  if (part.positions.size() > static_cast<std::size_t>(kLargest))
    return buffer.add(part.corners, kIndices, {{"componentType", kUnsignedInt}, {"type", "SCALAR"}});
  const std::vector<std::uint16_t> corners(part.corners.begin(), part.corners.end());
  return buffer.add(corners, kIndices, {{"componentType", kUnsignedShort}, {"type", "SCALAR"}});
}

std::size_t add_colours(const GlbPart& part, Buffer& buffer) {
  std::vector<std::array<std::uint16_t, 4>> colours;  // a multiple of four bytes each, as the format wants
  colours.reserve(part.colours.size());
  for (const Rgb& colour : part.colours) {
    const auto channel = [&](int c) {
      return static_cast<std::uint16_t>(
          std::lround(kLargest * std::min(std::max(static_cast<float>(colour[c]), 0.0F), 1.0F)));
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
               const GlbStyle& style) {
  const bool is_quantised = style.encoding == GlbEncoding::quantised;
  const Grid grid = is_quantised ? grid_of(parts) : Grid{};
  Buffer buffer;
  json nodes = json::array(), meshes = json::array(), children = json::array();
  nodes.push_back({{"name", "fluxel"}});
  for (const GlbPart& part : parts) {
    if (part.corners.empty()) continue;
    json attributes{{"POSITION", is_quantised ? add_quantised_positions(part, grid, buffer)
                                              : add_positions(part, buffer)},
                    {"COLOR_0", add_colours(part, buffer)}};
    if (!is_quantised) attributes["_RADIOSITY"] = add_radiosity(part, buffer);
    const std::size_t indices =
        is_quantised
            ? add_indices(part, buffer)
            : buffer.add(part.corners, kIndices, {{"componentType", kUnsignedInt}, {"type", "SCALAR"}});
    children.push_back(nodes.size());
    json node{{"name", part.name}, {"mesh", meshes.size()}};
    if (is_quantised) {
      node["translation"] = vector_json(grid.low);
      node["scale"] = {grid.step, grid.step, grid.step};
    }
    nodes.push_back(std::move(node));
    meshes.push_back(
        {{"name", part.name},
         {"primitives", json::array({{{"attributes", attributes}, {"indices", indices}, {"material", 0}}})}});
  }
  json& root = nodes.front();
  root["children"] = children;
  // The root is moved after it is turned.
  const glm::dvec3 at = style.z_up ? glm::dvec3(origin.x, origin.z, -origin.y) : origin;
  root["translation"] = {at.x, at.y, at.z};
  if (style.z_up) root["rotation"] = kZToY;
  json document{
      {"asset", {{"version", "2.0"}, {"generator", style.generator}}},
      {"scene", 0},
      {"scenes", json::array({{{"nodes", {0}}}})},
      {"nodes", nodes},
      {"meshes", meshes},
      {"extensionsUsed", {"KHR_materials_unlit"}},
      {"materials", json::array({{{"name", "radiosity"},
                                  {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}},
                                  {"extensions", {{"KHR_materials_unlit", json::object()}}}}})}};
  if (is_quantised) {
    document["extensionsUsed"].push_back("KHR_mesh_quantization");
    document["extensionsRequired"] = {"KHR_mesh_quantization"};
  }
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
