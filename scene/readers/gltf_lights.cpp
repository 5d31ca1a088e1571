#include "scene/readers/gltf_lights.hpp"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <optional>

#include "scene/readers/statements.hpp"
#include "scene/readers/unique_names.hpp"

namespace fluxel {
namespace {

constexpr int kFalloffSteps = 64;

std::optional<std::size_t> light_of(const tinygltf::Node& node) {
  const auto extension = node.extensions.find("KHR_lights_punctual");
  if (extension == node.extensions.end()) return std::nullopt;
  return static_cast<std::size_t>(extension->second.Get("light").GetNumberAsInt());
}

IntensityTable intensity_of(const GltfFile& gltf, std::size_t k) {
  const tinygltf::Light& light = gltf.model->lights[k];
  const std::string where = "extensions.KHR_lights_punctual." + gltf_element("lights", k);
  if (light.type == "point") return {{0}, {0, std::numbers::pi}, {1, 1}};
  if (light.type == "directional") {
    throw gltf.error(where, "directional lights, as of the sun, are not modelled",
                     "remove it from the scene");
  }
  if (light.type != "spot") {
    throw gltf.error(where + ".type", fmt::format("{} is no kind of light", in_quotes(light.type)),
                     "known: point, spot");
  }
  if (light.spot.innerConeAngle > light.spot.outerConeAngle) {
    throw gltf.error(where + ".spot", fmt::format("inner cone angle {} is above the outer one {}",
                                                  light.spot.innerConeAngle, light.spot.outerConeAngle));
  }
  return spot_intensity(light.spot.innerConeAngle, light.spot.outerConeAngle);
}

Luminaire place_light(const GltfFile& gltf, const GltfNode& node, const tinygltf::Light& light) {
  Luminaire luminaire;
  luminaire.position = node.to_world[3];
  if (light.type == "spot") {
    luminaire.aim = node_direction(gltf, node, {0, 0, -1});
    const glm::dvec3 side = node_direction(gltf, node, {1, 0, 0});
    const glm::dvec3 across = side - glm::dot(side, luminaire.aim) * luminaire.aim;
    if (!(glm::length(across) > 0))
      throw gltf.error(gltf_element("nodes", node.node), "its scale leaves a light no direction");
    luminaire.ahead = glm::normalize(across);
  }
  const Rgb colour = light.color.empty() ? Rgb(1) : Rgb(light.color[0], light.color[1], light.color[2]);
  luminaire.scale = light.intensity * colour;
  return luminaire;
}

}  // namespace

IntensityTable spot_intensity(double inner, double outer) {
  IntensityTable table{{0}, {0}, {1}};
  const auto add = [&table](double gamma, double intensity) {
    table.gamma.push_back(gamma);
    table.intensity.push_back(intensity);
  };
  if (inner > 0) add(inner, 1);
  if (!(inner < outer)) return table;
  for (int k = 1; k <= kFalloffSteps; ++k) {
    const double gamma = inner + (outer - inner) * k / kFalloffSteps;
    const double linear = (std::cos(gamma) - std::cos(outer)) / (std::cos(inner) - std::cos(outer));
    add(gamma, k == kFalloffSteps ? 0 : linear * linear);
  }
  return table;
}

void add_gltf_lights(const GltfFile& gltf, const std::vector<GltfNode>& nodes, SceneInput& scene) {
  std::map<std::size_t, std::uint32_t> tables;
  UniqueNames names;
  for (const GltfNode& node : nodes) {
    const tinygltf::Node& given = gltf.model->nodes[node.node];
    const std::optional<std::size_t> k = light_of(given);
    if (!k) continue;
    const tinygltf::Light& light = gltf.model->lights[*k];
    const auto [table, added] = tables.try_emplace(*k, static_cast<std::uint32_t>(scene.intensities.size()));
    if (added) scene.intensities.push_back(intensity_of(gltf, *k));
    Luminaire luminaire = place_light(gltf, node, light);
    luminaire.intensity = table->second;
    luminaire.name = names.add(!given.name.empty()   ? given.name
                               : !light.name.empty() ? light.name
                                                     : fmt::format("light {}", *k));
    scene.luminaires.push_back(std::move(luminaire));
  }
}

}  // namespace fluxel
