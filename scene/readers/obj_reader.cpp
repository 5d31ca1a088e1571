#include "scene/readers/obj_reader.hpp"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <charconv>
#include <map>
#include <sstream>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "core/input_error_at.hpp"
#include "scene/readers/default_material.hpp"
#include "scene/readers/obj_check.hpp"
#include "scene/readers/obj_textures.hpp"

namespace fluxel {
namespace {

static_assert(std::is_same_v<tinyobj::real_t, double>, "link the parser in double precision");

constexpr const char* kDefaultGroup = "default";

/// What the parser's callbacks fill.
struct Builder {
  explicit Builder(SceneInput& target) : scene(target) {}

  SceneInput& scene;
  std::unordered_map<std::string, MaterialId> materials;
  std::unordered_map<std::string, GroupId> groups;
  std::vector<glm::dvec3> vertices;
  std::vector<std::vector<std::size_t>> faces;  ///< vertex indices from 0; a face may name later vertices
  std::optional<MaterialId> material;           ///< of the last usemtl
  std::optional<GroupId> group;                 ///< of the last g or o
  std::size_t faces_without_material = 0;
  std::vector<bool> has_maps;  ///< of each material
  ObjTextures textures;

  void use_group(const std::string& name) {
    const auto [entry, added] = groups.try_emplace(name, GroupId{static_cast<std::uint32_t>(groups.size())});
    if (added) scene.groups.push_back(name);
    group = entry->second;
  }

  [[nodiscard]] MaterialId default_material() {
    const auto [entry, added] = materials.try_emplace(
        kDefaultMaterial, MaterialId{static_cast<std::uint32_t>(scene.materials.size())});
    if (added) scene.materials.emplace_back().name = kDefaultMaterial;
    return entry->second;
  }

  void add_face(const tinyobj::index_t* corners, int count) {
    if (!group) use_group(kDefaultGroup);
    if (!material) ++faces_without_material;
    std::vector<std::size_t>& face = faces.emplace_back();
    face.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) face.push_back(static_cast<std::size_t>(corners[i].vertex_index - 1));
    if (material && has_maps[index(*material)]) add_texture(corners, count);
    scene.polygons.push_back({{}, material ? *material : default_material(), *group});
  }

  /// Of the face whose polygon is next.
  void add_texture(const tinyobj::index_t* corners, int count) {
    TexturedFace& face = textures.faces.emplace_back();
    face.polygon = scene.polygons.size();
    for (int i = 0; i < count && corners[i].texcoord_index > 0; ++i)
      face.corners.push_back(static_cast<std::size_t>(corners[i].texcoord_index - 1));
    if (face.corners.size() < static_cast<std::size_t>(count)) face.corners.clear();
  }
};

Builder& builder_of(void* user_data) { return *static_cast<Builder*>(user_data); }

tinyobj::callback_t make_callbacks() {
  tinyobj::callback_t callbacks;
  callbacks.vertex_cb = [](void* user_data, double x, double y, double z, double) {
    builder_of(user_data).vertices.emplace_back(x, y, z);
  };
  callbacks.texcoord_cb = [](void* user_data, double u, double v, double) {
    builder_of(user_data).textures.coordinates.emplace_back(u, v);
  };
  callbacks.index_cb = [](void* user_data, tinyobj::index_t* corners, int count) {
    builder_of(user_data).add_face(corners, count);
  };
  callbacks.usemtl_cb = [](void* user_data, const char* name, int) {
    Builder& builder = builder_of(user_data);
    builder.material = builder.materials.at(name);
  };
  callbacks.object_cb = [](void* user_data, const char* name) { builder_of(user_data).use_group(name); };
  return callbacks;
}

/// From the statements that the parser does not know; they have been checked.
InputHeat read_heat(const std::map<std::string, std::string>& statements) {
  InputHeat heat;
  for (const auto& [name, text] : statements) {
    double value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    static_cast<void>(set_heat(name, value, TemperatureUnit::kelvin, heat));
  }
  return heat;
}

void read_materials(CheckedMaterials& checked, Builder& builder) {
  std::istringstream stream(std::move(checked.text));
  std::map<std::string, int> names;
  std::vector<tinyobj::material_t> materials;
  std::string warnings, errors;
  tinyobj::LoadMtl(&names, &materials, &stream, &warnings, &errors);
  for (const tinyobj::material_t& material : materials) {
    if (material.name.empty()) continue;  // the parser adds one where the text has none
    builder.materials.emplace(material.name,
                              MaterialId{static_cast<std::uint32_t>(builder.scene.materials.size())});
    InputMaterial& added = builder.scene.materials.emplace_back();
    added.name = material.name;
    added.rho = {material.diffuse[0], material.diffuse[1], material.diffuse[2]};
    added.Ke = {material.emission[0], material.emission[1], material.emission[2]};
    added.heat = read_heat(material.unknown_parameter);
    builder.has_maps.push_back(checked.maps.contains(material.name));
  }
}

}  // namespace

SceneInput read_obj_text(const std::filesystem::path& file, const std::string& text,
                         const TextLookup& lookup) {
  CheckedObj checked = check_obj_text(file, text, lookup);
  SceneInput scene;
  scene.name = file.stem().string();
  scene.file = file;
  scene.geometry.push_back({.file = file});
  scene.notes = std::move(checked.materials.notes);

  Builder builder(scene);
  read_materials(checked.materials, builder);
  std::istringstream geometry(std::move(checked.geometry));
  tinyobj::LoadObjWithCallback(geometry, make_callbacks(), &builder);

  if (scene.polygons.empty()) throw input_error_at(file, 0, "holds no face", "no statement begins with 'f'");
  for (std::size_t i = 0; i < builder.faces.size(); ++i) {
    for (const std::size_t vertex : builder.faces[i]) {
      scene.polygons[i].corners.push_back(builder.vertices[vertex]);
    }
  }
  apply_textures(checked.materials.maps, builder.textures, lookup, scene);
  if (builder.faces_without_material > 0) {
    const Rgb rho = scene.materials[index(builder.default_material())].rho;
    scene.notes.push_back(fmt::format(
        "{}: {} of {} faces have no material and get '{}', reflectance {} {} {}", file.string(),
        builder.faces_without_material, scene.polygons.size(), kDefaultMaterial, rho.r, rho.g, rho.b));
  }
  return scene;
}

}  // namespace fluxel
