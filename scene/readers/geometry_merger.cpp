#include "scene/readers/geometry_merger.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "core/input_error_at.hpp"
#include "scene/readers/placing.hpp"

namespace fluxel {

void GeometryMerger::add(SceneInput part, const InputGeometry& geometry) {
  place(part, geometry);
  scene_.geometry.push_back(geometry);
  std::vector<MaterialId> materials;
  for (InputMaterial& material : part.materials) materials.push_back(merge(std::move(material), part.file));
  std::vector<GroupId> groups;
  for (std::string& group : part.groups) groups.push_back(merge(std::move(group)));
  merge_face_rho(part, materials);
  for (InputPolygon& polygon : part.polygons) {
    polygon.material = materials[index(polygon.material)];
    polygon.group = groups[index(polygon.group)];
    scene_.polygons.push_back(std::move(polygon));
  }
  for (InputCamera& camera : part.cameras) {
    scene_.cameras.push_back(std::move(camera));
  }
  const auto tables = static_cast<std::uint32_t>(scene_.intensities.size());
  for (Luminaire& luminaire : part.luminaires) {
    luminaire.intensity += tables;
    scene_.luminaires.push_back(std::move(luminaire));
  }
  std::ranges::move(part.intensities, std::back_inserter(scene_.intensities));
  for (std::string& note : part.notes) {
    const bool known = std::find(scene_.notes.begin(), scene_.notes.end(), note) != scene_.notes.end();
    if (!known) scene_.notes.push_back(std::move(note));
  }
}

/// Before the polygons are: those of files without textures have what their material says.
void GeometryMerger::merge_face_rho(const SceneInput& part, const std::vector<MaterialId>& materials) {
  if (part.face_rho.empty() && scene_.face_rho.empty()) return;
  const auto rho_of = [&](MaterialId material) { return scene_.materials[index(material)].rho; };
  for (std::size_t k = scene_.face_rho.size(); k < scene_.polygons.size(); ++k)
    scene_.face_rho.push_back(rho_of(scene_.polygons[k].material));
  scene_.face_rho.insert(scene_.face_rho.end(), part.face_rho.begin(), part.face_rho.end());
  for (std::size_t k = part.face_rho.size(); k < part.polygons.size(); ++k)
    scene_.face_rho.push_back(rho_of(materials[index(part.polygons[k].material)]));
}

MaterialId GeometryMerger::merge(InputMaterial material, const std::filesystem::path& file) {
  const auto next = static_cast<std::uint32_t>(scene_.materials.size());
  const auto [entry, added] = materials_.try_emplace(material.name, MaterialId{next}, file);
  auto& [id, first_file] = entry->second;
  if (added) {
    scene_.materials.push_back(std::move(material));
    return id;
  }
  InputMaterial& first = scene_.materials[index(id)];
  if (material.is_named_alone) return id;
  if (first.is_named_alone) {
    first = std::move(material);
    first_file = file;
    for (std::size_t k = 0; k < scene_.face_rho.size(); ++k)
      if (scene_.polygons[k].material == id) scene_.face_rho[k] = first.rho;
    return id;
  }
  const bool both_textured = first.textured && material.textured;  // of other faces
  if (first.textured != material.textured || (first.rho != material.rho && !both_textured) ||
      first.Ke != material.Ke || first.E != material.E || first.sides != material.sides ||
      first.heat != material.heat) {
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
