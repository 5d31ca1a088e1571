#include "scene/readers/geometry_merger.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"

namespace fluxel {

void GeometryMerger::add(SceneInput part, const InputGeometry& geometry) {
  scene_.geometry.push_back(geometry);
  std::vector<MaterialId> materials;
  for (InputMaterial& material : part.materials) materials.push_back(merge(std::move(material), part.file));
  std::vector<GroupId> groups;
  for (std::string& group : part.groups) groups.push_back(merge(std::move(group)));
  for (InputPolygon& polygon : part.polygons) {
    for (glm::dvec3& corner : polygon.corners) {
      corner = geometry.metres_per_unit * corner + geometry.translate;
    }
    polygon.material = materials[index(polygon.material)];
    polygon.group = groups[index(polygon.group)];
    scene_.polygons.push_back(std::move(polygon));
  }
  for (std::string& note : part.notes) {
    const bool known = std::find(scene_.notes.begin(), scene_.notes.end(), note) != scene_.notes.end();
    if (!known) scene_.notes.push_back(std::move(note));
  }
}

MaterialId GeometryMerger::merge(InputMaterial material, const std::filesystem::path& file) {
  const auto next = static_cast<std::uint32_t>(scene_.materials.size());
  const auto [entry, added] = materials_.try_emplace(material.name, MaterialId{next}, file);
  const auto& [id, first_file] = entry->second;
  if (added) {
    scene_.materials.push_back(std::move(material));
    return id;
  }
  const InputMaterial& first = scene_.materials[index(id)];
  if (first.rho != material.rho || first.Ke != material.Ke || first.heat != material.heat) {
    throw input_error_at(scene_.file, 0,
                         fmt::format("material '{}' has one value in {} and another in {}", material.name,
                                     first_file.string(), file.string()),
                         "rename one of them");
  }
  return id;
}

GroupId GeometryMerger::merge(std::string group) {
  const auto next = static_cast<std::uint32_t>(scene_.groups.size());
  const auto [entry, added] = groups_.try_emplace(group, GroupId{next});
  if (added) scene_.groups.push_back(std::move(group));
  return entry->second;
}

}  // namespace fluxel
