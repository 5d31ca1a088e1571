#include "output/elements/glb_writer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <utility>

namespace fluxel {

namespace {

using nlohmann::json;

constexpr float kLargest = 65535;  // of numbers of 16 bits: a colour's channel of 1, the end of a grid

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

/// Of a multiple of four bytes each, as the format wants: three numbers and a rest.
std::size_t add_quantised_positions(const GlbPart& part, const Grid& grid, GlbBuffer& buffer) {
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
  return buffer.add(positions, kGltfVertices,
                    {{"componentType", kGltfUnsignedShort}, {"type", "VEC3"}, {"min", low}, {"max", high}},
                    true);
}

/// Of 16 bits where these suffice.
std::size_t add_indices(const GlbPart& part, GlbBuffer& buffer) {
  if (part.positions.size() > static_cast<std::size_t>(kLargest)) return buffer.add_indices(part.corners);
  const std::vector<std::uint16_t> corners(part.corners.begin(), part.corners.end());
  return buffer.add(corners, kGltfIndices, {{"componentType", kGltfUnsignedShort}, {"type", "SCALAR"}});
}

std::size_t add_colours(const GlbPart& part, GlbBuffer& buffer) {
  std::vector<std::array<std::uint16_t, 4>> colours;  // a multiple of four bytes each, as the format wants
  colours.reserve(part.colours.size());
  for (const Rgb& colour : part.colours) {
    const auto channel = [&](int c) {
      return static_cast<std::uint16_t>(
          std::lround(kLargest * std::min(std::max(static_cast<float>(colour[c]), 0.0F), 1.0F)));
    };
    colours.push_back({channel(0), channel(1), channel(2), 65535});
  }
  return buffer.add(colours, kGltfVertices,
                    {{"componentType", kGltfUnsignedShort}, {"type", "VEC4"}, {"normalized", true}});
}

std::size_t add_radiosity(const GlbPart& part, GlbBuffer& buffer) {
  std::vector<glm::vec3> radiosity(part.radiosity.begin(), part.radiosity.end());
  return buffer.add(radiosity, kGltfVertices, {{"componentType", kGltfFloat}, {"type", "VEC3"}});
}

}  // namespace

void write_glb(const std::filesystem::path& file, std::span<const GlbPart> parts, GlbEncoding encoding,
               const GlbScene& scene) {
  const bool is_quantised = encoding == GlbEncoding::quantised;
  const Grid grid = is_quantised ? grid_of(parts) : Grid{};
  GlbBuffer buffer;
  json nodes = json::array(), meshes = json::array();
  for (const GlbPart& part : parts) {
    if (part.corners.empty()) continue;
    json attributes{{"POSITION", is_quantised ? add_quantised_positions(part, grid, buffer)
                                              : buffer.add_positions(part.positions)},
                    {"COLOR_0", add_colours(part, buffer)}};
    if (!is_quantised) attributes["_RADIOSITY"] = add_radiosity(part, buffer);
    const std::size_t indices = is_quantised ? add_indices(part, buffer) : buffer.add_indices(part.corners);
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
  json document = document_of(scene, nodes, meshes, json::array({unlit_material("radiosity")}));
  if (is_quantised) {
    document["extensionsUsed"].push_back("KHR_mesh_quantization");
    document["extensionsRequired"] = {"KHR_mesh_quantization"};
  }
  write_glb_file(file, std::move(document), buffer);
}

}  // namespace fluxel
