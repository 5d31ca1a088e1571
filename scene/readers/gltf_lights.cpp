#include "scene/readers/gltf_lights.hpp"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <string_view>

#include "scene/readers/statements.hpp"
#include "scene/readers/unique_names.hpp"

namespace fluxel {
namespace {

constexpr int kFalloffSteps = 64;

IntensityTable intensity_of(const GltfFile& gltf, const GltfValue& light, std::size_t k) {
  const std::string_view type = light["type"].text();
  const std::string where = "extensions.KHR_lights_punctual." + gltf_element("lights", k);
  if (type == "point") return {{0}, {0, std::numbers::pi}, {1, 1}};
  if (type == "directional") {
    throw gltf.error(where, "directional lights, as of the sun, are not modelled",
                     "remove it from the scene");
  }
  if (type != "spot") {
    throw gltf.error(where + ".type", fmt::format("{} is no kind of light", in_quotes(type)),
                     "known: point, spot");
  }
  const GltfValue spot = light["spot"];
  if (!spot.given()) throw gltf.error(where + ".spot", "is missing");
  const double inner = spot["innerConeAngle"].number(0);
  const double outer = spot["outerConeAngle"].number(std::numbers::pi / 4);
  if (inner > outer) {
    throw gltf.error(where + ".spot",
                     fmt::format("inner cone angle {} is above the outer one {}", inner, outer));
  }
  return spot_intensity(inner, outer);
}

Luminaire place_light(const GltfFile& gltf, const GltfNode& node, const GltfValue& light) {
  Luminaire luminaire;
  luminaire.position = node.to_world[3];
  if (light["type"].text() == "spot") {
    luminaire.aim = node_direction(gltf, node, {0, 0, -1});
    const glm::dvec3 side = node_direction(gltf, node, {1, 0, 0});
    const glm::dvec3 across = side - glm::dot(side, luminaire.aim) * luminaire.aim;
    if (!(glm::length(across) > 0))
      throw gltf.error(gltf_element("nodes", node.node), "its scale leaves a light no direction");
    luminaire.ahead = glm::normalize(across);
  }
  luminaire.scale = light["intensity"].number(1) * light["color"].vector(Rgb(1));
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
    const GltfValue given = gltf["nodes"][node.node];
    const GltfValue index = given["extensions"]["KHR_lights_punctual"]["light"];
    if (!index.given()) continue;
    const std::size_t k = index.whole();
    const GltfValue light = gltf["extensions"]["KHR_lights_punctual"]["lights"][k];
    const auto [table, added] = tables.try_emplace(k, static_cast<std::uint32_t>(scene.intensities.size()));
    if (added) scene.intensities.push_back(intensity_of(gltf, light, k));
    Luminaire luminaire = place_light(gltf, node, light);
    luminaire.intensity = table->second;
    luminaire.name = names.add(gltf_name({given, light}, fmt::format("light {}", k)));
    scene.luminaires.push_back(std::move(luminaire));
  }
}

}  // namespace fluxel
