#include "scene/readers/gltf_materials.hpp"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/readers/unique_names.hpp"

namespace fluxel {
namespace {

constexpr double kMaxEmission = 1e15;  // as for E of a scene file

double number_of(const tinygltf::Value& object, const char* key, double otherwise) {
  return object.Has(key) ? object.Get(key).GetNumberAsDouble() : otherwise;
}

glm::dvec2 pair_of(const tinygltf::Value& object, const char* key, const glm::dvec2& otherwise) {
  if (!object.Has(key)) return otherwise;
  const tinygltf::Value& pair = object.Get(key);
  return {pair.Get(0).GetNumberAsDouble(), pair.Get(1).GetNumberAsDouble()};
}

std::optional<GltfTextureUse> texture_use(const GltfFile& gltf, const tinygltf::TextureInfo& given) {
  if (given.index < 0) return std::nullopt;
  const auto texture = static_cast<std::size_t>(given.index);
  const int source = gltf.model->textures[texture].source;
  if (source < 0) throw gltf.error(gltf_element("textures", texture), "names no image");
  GltfTextureUse use;
  use.image = static_cast<std::size_t>(source);
  int set = given.texCoord;
  const auto extension = given.extensions.find("KHR_texture_transform");
  if (extension != given.extensions.end()) {
    const tinygltf::Value& transform = extension->second;
    const double angle = number_of(transform, "rotation", 0), c = std::cos(angle), s = std::sin(angle);
    const glm::dvec2 scale = pair_of(transform, "scale", glm::dvec2(1));
    // Counter-clockwise as one sees the image, whose v goes down.
    use.linear = glm::dmat2(glm::dvec2(c, -s) * scale.x, glm::dvec2(s, c) * scale.y);
    use.offset = pair_of(transform, "offset", glm::dvec2(0));
    if (transform.Has("texCoord")) set = transform.Get("texCoord").GetNumberAsInt();
  }
  use.coordinates = fmt::format("TEXCOORD_{}", set);
  return use;
}

GltfMaterial read_gltf_material(const GltfFile& gltf, std::size_t k, const std::string& name) {
  const tinygltf::Material& given = gltf.model->materials[k];
  GltfMaterial material;
  material.input.name = name;
  material.input.sides = given.doubleSided ? Sides::two : Sides::one;
  const std::vector<double>& colour = given.pbrMetallicRoughness.baseColorFactor;
  material.input.rho = {colour[0], colour[1], colour[2]};
  material.base_colour = texture_use(gltf, given.pbrMetallicRoughness.baseColorTexture);

  const auto extension = given.extensions.find("KHR_materials_emissive_strength");
  const double strength =
      extension == given.extensions.end() ? 1 : number_of(extension->second, "emissiveStrength", 1);
  const std::vector<double>& emissive = given.emissiveFactor;
  const Rgb E = std::numbers::pi * strength * Rgb(emissive[0], emissive[1], emissive[2]);
  if (!(std::max({E.r, E.g, E.b}) <= kMaxEmission))
    throw gltf.error(gltf_element("materials", k), "emits too much",
                     fmt::format("at most {} lm/m2", kMaxEmission));
  material.input.E = E;
  if (E != Rgb(0)) material.emission = texture_use(gltf, given.emissiveTexture);
  return material;
}

}  // namespace

std::vector<GltfMaterial> read_gltf_materials(const GltfFile& gltf) {
  std::vector<GltfMaterial> materials;
  UniqueNames names;
  for (std::size_t k = 0; k < gltf.model->materials.size(); ++k) {
    const std::string& name = gltf.model->materials[k].name;
    materials.push_back(
        read_gltf_material(gltf, k, names.add(name.empty() ? fmt::format("material {}", k) : name)));
  }
  return materials;
}

}  // namespace fluxel
