#include "scene/readers/gltf_cameras.hpp"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <glm/trigonometric.hpp>

#include "scene/readers/unique_names.hpp"

namespace fluxel {

void add_gltf_cameras(const GltfFile& gltf, const std::vector<GltfNode>& nodes, SceneInput& scene) {
  UniqueNames names;
  for (const GltfNode& node : nodes) {
    const tinygltf::Node& given = gltf.model->nodes[node.node];
    if (given.camera < 0) continue;
    const tinygltf::Camera& camera = gltf.model->cameras[static_cast<std::size_t>(given.camera)];
    if (camera.type != "perspective") continue;
    const std::string name = !given.name.empty()    ? given.name
                             : !camera.name.empty() ? camera.name
                                                    : fmt::format("camera {}", given.camera);
    const glm::dvec3 eye = node.to_world[3];
    InputCamera& added = scene.cameras.emplace_back();
    added.name = {names.add(name)};
    added.eye = {eye};
    added.look_at = {eye + node_direction(gltf, node, {0, 0, -1})};
    added.up = {node_direction(gltf, node, {0, 1, 0})};
    added.fov = {glm::degrees(camera.perspective.yfov)};
  }
}

}  // namespace fluxel
