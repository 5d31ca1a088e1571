#include "scene/readers/gltf_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <unordered_map>
#include <utility>

#include "core/input_error_at.hpp"
#include "scene/face_materials.hpp"
#include "scene/readers/default_material.hpp"
#include "scene/readers/gltf_cameras.hpp"
#include "scene/readers/gltf_file.hpp"
#include "scene/readers/gltf_lights.hpp"
#include "scene/readers/gltf_materials.hpp"
#include "scene/readers/gltf_meshes.hpp"
#include "scene/readers/gltf_nodes.hpp"
#include "scene/readers/gltf_notes.hpp"
#include "scene/readers/gltf_textures.hpp"
#include "scene/readers/unique_names.hpp"

namespace fluxel {
namespace {

constexpr const char* kNoName = "default";  // of a group
constexpr double kMaxCorner = 1e15;         // as of an OBJ file

/// Makes the polygons of the nodes.
class PolygonBuilder {
 public:
  PolygonBuilder(const GltfFile& gltf, const GltfMeshes& meshes, SceneInput& scene)
      : gltf_(gltf), meshes_(meshes), scene_(scene) {
    scene_.polygons.reserve(meshes.triangles);
    has_images_ = std::ranges::any_of(meshes.meshes, [](const std::vector<GltfTriangles>& mesh) {
      return std::ranges::any_of(mesh, [](const GltfTriangles& triangles) { return !triangles.rho.empty(); });
    });
    if (has_images_) scene_.face_rho.reserve(meshes.triangles);
  }

  void add(const GltfNode& node) {
    const GltfValue given = gltf_["nodes"][node.node];
    if (!given["mesh"].given()) return;
    const std::size_t mesh = given["mesh"].whole();
    const GroupId group = group_of(gltf_name({given, gltf_["meshes"][mesh]}, kNoName));
    for (const GltfTriangles& triangles : meshes_.meshes[mesh]) add(node, triangles, group);
  }

  [[nodiscard]] std::size_t without_material() const { return without_material_; }

 private:
  void add(const GltfNode& node, const GltfTriangles& triangles, GroupId group) {
    const bool mirrors = glm::determinant(glm::dmat3(node.to_world)) < 0;
    const MaterialId material = material_of(triangles);
    for (std::size_t t = 0; t < triangles.corners.size(); ++t) {
      InputPolygon& polygon = scene_.polygons.emplace_back(InputPolygon{{}, material, group});
      polygon.corners.reserve(3);
      for (const std::size_t vertex : triangles.corners[t])
        polygon.corners.push_back(place(node, triangles, vertex));
      if (mirrors) std::ranges::reverse(polygon.corners);  // the front stays the front
      if (has_images_)
        scene_.face_rho.push_back(triangles.rho.empty() ? scene_.materials[index(material)].rho
                                                        : triangles.rho[t]);
    }
  }

  [[nodiscard]] glm::dvec3 place(const GltfNode& node, const GltfTriangles& triangles,
                                 std::size_t vertex) const {
    const glm::dvec3 corner = node.to_world * glm::dvec4(glm::dvec3(triangles.positions[vertex]), 1);
    for (int axis = 0; axis < 3; ++axis) {
      if (!(std::abs(corner[axis]) <= kMaxCorner)) {
        throw gltf_.error(triangles.where(),
                          fmt::format("POSITION of vertex {} is not a finite number, or too large", vertex),
                          fmt::format("at most {} where nodes[{}] puts it", kMaxCorner, node.node));
      }
    }
    return corner;
  }

  GroupId group_of(const std::string& name) {
    const auto [entry, added] =
        groups_.try_emplace(name, GroupId{static_cast<std::uint32_t>(scene_.groups.size())});
    if (added) scene_.groups.push_back(name);
    return entry->second;
  }

  MaterialId material_of(const GltfTriangles& triangles) {
    if (triangles.material) return MaterialId{static_cast<std::uint32_t>(*triangles.material)};
    without_material_ += triangles.corners.size();
    if (!default_material_) {
      default_material_ = MaterialId{static_cast<std::uint32_t>(scene_.materials.size())};
      UniqueNames names;
      for (const InputMaterial& material : scene_.materials) static_cast<void>(names.add(material.name));
      InputMaterial& added = scene_.materials.emplace_back();
      added.name = names.add(kDefaultMaterial);
      added.sides = Sides::one;
    }
    return *default_material_;
  }

  const GltfFile& gltf_;
  const GltfMeshes& meshes_;
  SceneInput& scene_;
  std::unordered_map<std::string, GroupId> groups_;
  std::optional<MaterialId> default_material_;
  std::size_t without_material_ = 0;
  bool has_images_ = false;
};

void add_polygons(const GltfFile& gltf, const std::vector<GltfNode>& nodes, const GltfMeshes& meshes,
                  SceneInput& scene) {
  PolygonBuilder builder(gltf, meshes, scene);
  for (const GltfNode& node : nodes) builder.add(node);
  if (scene.polygons.empty())
    throw input_error_at(gltf.path, 0, "holds no triangle", "no node of its scene has a mesh of triangles");
  if (meshes.points_and_lines > 0) {
    scene.notes.push_back(fmt::format("{}: primitives of points or lines are left out ({})",
                                      gltf.path.string(), meshes.points_and_lines));
  }
  if (builder.without_material() > 0) {
    const Rgb rho = InputMaterial{}.rho;
    scene.notes.push_back(fmt::format(
        "{}: {} of {} triangles have no material and get '{}', reflectance {} {} {}", gltf.path.string(),
        builder.without_material(), scene.polygons.size(), scene.materials.back().name, rho.r, rho.g, rho.b));
  }
}

bool emits(const SceneInput& scene) {
  return !scene.luminaires.empty() || std::ranges::any_of(scene.materials, [](const InputMaterial& material) {
    return material.E.value_or(Rgb(0)) != Rgb(0);
  });
}

}  // namespace

SceneInput read_gltf(const std::filesystem::path& file, const std::string& bytes, const TextLookup& lookup) {
  const GltfFile gltf = open_gltf(file, bytes, lookup);
  require_known_extensions(gltf);
  SceneInput scene;
  scene.name = file.stem().string();
  scene.file = file;
  scene.geometry.push_back({.file = file});

  const std::vector<GltfNode> nodes = place_gltf_nodes(gltf);
  std::size_t size = bytes.size();
  for (const std::string_view buffer : gltf.buffers) size += buffer.size();
  GltfMeshes meshes = read_gltf_meshes(gltf, nodes, size);
  std::vector<GltfMaterial> materials = read_gltf_materials(gltf);
  apply_gltf_textures(gltf, lookup, meshes, materials);
  for (GltfMaterial& material : materials) scene.materials.push_back(std::move(material.input));

  scene.notes = gltf_notes(gltf, nodes);
  add_polygons(gltf, nodes, meshes, scene);
  set_mean_reflectance(scene);
  add_gltf_lights(gltf, nodes, scene);
  add_gltf_cameras(gltf, nodes, scene);
  if (emits(scene)) scene.units = Units::photometric;
  return scene;
}

}  // namespace fluxel
