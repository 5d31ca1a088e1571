#include "output/elements/textured_glb.hpp"

#include <map>
#include <utility>

namespace fluxel {

namespace {

using nlohmann::json;

/// Constants of glTF. A texture that is read between its texels, and not beyond its edge; coarser versions
/// would mix charts.
constexpr int kLinear = 9729, kClampToEdge = 33071;

json primitive_of(const TexturedPart& part, std::size_t material, GlbBuffer& buffer) {
  const json pairs{{"componentType", kGltfFloat}, {"type", "VEC2"}};
  const json attributes{{"POSITION", buffer.add_positions(part.positions)},
                        {"TEXCOORD_0", buffer.add(part.along_surface, kGltfVertices, pairs)},
                        {"TEXCOORD_1", buffer.add(part.in_texture, kGltfVertices, pairs)}};
  return {{"attributes", attributes}, {"indices", buffer.add_indices(part.corners)}, {"material", material}};
}

}  // namespace

void write_textured_glb(const std::filesystem::path& file, std::span<const TexturedPart> parts,
                        std::string_view png, const GlbScene& scene) {
  GlbBuffer buffer;
  json nodes = json::array(), meshes = json::array(), materials = json::array();
  std::map<std::string, std::size_t> numbers;
  for (const TexturedPart& part : parts) {
    const auto [material, is_new] = numbers.try_emplace(part.material, materials.size());
    if (is_new) {
      materials.push_back(unlit_material(part.material));
      materials.back()["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}, {"texCoord", 1}};
    }
    if (meshes.empty() || meshes.back()["name"] != part.name) {
      nodes.push_back({{"name", part.name}, {"mesh", meshes.size()}});
      meshes.push_back({{"name", part.name}, {"primitives", json::array()}});
    }
    meshes.back()["primitives"].push_back(primitive_of(part, material->second, buffer));
  }
  json document = document_of(scene, nodes, meshes, materials);
  document["textures"] = json::array({{{"source", 0}, {"sampler", 0}}});
  document["samplers"] = json::array(
      {{{"magFilter", kLinear}, {"minFilter", kLinear}, {"wrapS", kClampToEdge}, {"wrapT", kClampToEdge}}});
  document["images"] = json::array(
      {{{"name", "light map"}, {"mimeType", "image/png"}, {"bufferView", buffer.add_bytes(png)}}});
  write_glb_file(file, std::move(document), buffer);
}

}  // namespace fluxel
