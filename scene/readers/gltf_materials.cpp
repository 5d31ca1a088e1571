#include "scene/readers/gltf_materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/readers/unique_names.hpp"

namespace fluxel {
namespace {

constexpr double kMaxGltfEmission = 1e15;  // as for E of a scene file

std::optional<GltfTextureUse> texture_use(const GltfFile& gltf, const GltfValue& given) {
  if (!given.given()) return std::nullopt;
  const std::size_t texture = given["index"].whole();
  const GltfValue source = gltf["textures"][texture]["source"];
  if (!source.given()) throw gltf.error(gltf_element("textures", texture), "names no image");
  GltfTextureUse use;
  use.image = source.whole();
  const GltfValue transform = given["extensions"]["KHR_texture_transform"];
  const double angle = transform["rotation"].number(0), c = std::cos(angle), s = std::sin(angle);
  const auto scale = transform["scale"].vector(glm::dvec2(1));
  // Counter-clockwise as one sees the image, whose v goes down.
  use.linear = glm::dmat2(glm::dvec2(c, -s) * scale.x, glm::dvec2(s, c) * scale.y);
  use.offset = transform["offset"].vector(glm::dvec2(0));
  use.coordinates = fmt::format("TEXCOORD_{}", transform["texCoord"].whole(given["texCoord"].whole()));
  return use;
}

GltfMaterial read_gltf_material(const GltfFile& gltf, std::size_t k, const std::string& name) {
  const GltfValue given = gltf["materials"][k], base = given["pbrMetallicRoughness"];
  GltfMaterial material;
  material.input.name = name;
  material.input.sides = given["doubleSided"].is_true() ? Sides::two : Sides::one;
  material.input.rho = base["baseColorFactor"].vector(Rgb(1));
  material.base_colour = texture_use(gltf, base["baseColorTexture"]);

  const double strength =
      given["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"].number(1);
  const Rgb E = std::numbers::pi * strength * given["emissiveFactor"].vector(Rgb(0));
  if (!(std::max({E.r, E.g, E.b}) <= kMaxGltfEmission))
    throw gltf.error(gltf_element("materials", k), "emits too much",
                     fmt::format("at most {} lm/m2", kMaxGltfEmission));
  material.input.E = E;
  if (E != Rgb(0)) material.emission = texture_use(gltf, given["emissiveTexture"]);
  return material;
}

}  // namespace

std::vector<GltfMaterial> read_gltf_materials(const GltfFile& gltf) {
  std::vector<GltfMaterial> materials;
  UniqueNames names;
  const GltfValue given = gltf["materials"];
  for (std::size_t k = 0; k < given.size(); ++k) {
    const std::string name = gltf_name({given[k]}, fmt::format("material {}", k));
    materials.push_back(read_gltf_material(gltf, k, names.add(name)));
  }
  return materials;
}

}  // namespace fluxel
