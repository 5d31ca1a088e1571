#include "scene/readers/gltf_cameras.hpp"

#include <fmt/format.h>

#include <glm/trigonometric.hpp>

#include "scene/readers/unique_names.hpp"

namespace fluxel {

void add_gltf_cameras(const GltfFile& gltf, const std::vector<GltfNode>& nodes, SceneInput& scene) {
  UniqueNames names;
  for (const GltfNode& node : nodes) {
    const GltfValue given = gltf["nodes"][node.node];
    if (!given["camera"].given()) continue;
    const std::size_t k = given["camera"].whole();
    const GltfValue camera = gltf["cameras"][k];
    if (camera["type"].text() != "perspective") continue;
    const GltfValue yfov = camera["perspective"]["yfov"];
    if (!yfov.given()) throw gltf.error(gltf_element("cameras", k) + ".perspective", "is missing");
    const glm::dvec3 eye = node.to_world[3];
    InputCamera& added = scene.cameras.emplace_back();
    added.name = {names.add(gltf_name({given, camera}, fmt::format("camera {}", k)))};
    added.eye = {eye};
    added.look_at = {eye + node_direction(gltf, node, {0, 0, -1})};
    added.up = {node_direction(gltf, node, {0, 1, 0})};
    added.fov = {glm::degrees(yfov.number(0))};
  }
}

}  // namespace fluxel
