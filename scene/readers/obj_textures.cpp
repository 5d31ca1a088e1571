#include "scene/readers/obj_textures.hpp"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "scene/face_materials.hpp"
#include "scene/list_names.hpp"
#include "scene/polygon.hpp"
#include "scene/readers/texture.hpp"

namespace fluxel {
namespace {

constexpr double kUnknownReflectance = 0.5;  // as of faces without a material

/// A map of a material that faces use.
struct MapUse {
  MaterialId material{};
  const MaterialMaps* of = nullptr;
  bool emits = false;  ///< map_Ke, not map_Kd

  [[nodiscard]] const TextureMap& map() const { return emits ? *of->Ke : *of->Kd; }
};

class TextureApplier {
 public:
  TextureApplier(const ObjTextures& textures, const TextLookup& lookup, SceneInput& scene)
      : textures_(textures), lookup_(lookup), scene_(scene), faces_(scene.materials.size()) {
    for (const TexturedFace& face : textures.faces)
      faces_[index(scene.polygons[face.polygon].material)].push_back(&face);
  }

  void run(const std::map<std::string, MaterialMaps>& maps) {
    for (std::size_t m = 0; m < faces_.size(); ++m) {
      const auto found = maps.find(scene_.materials[m].name);
      if (faces_[m].empty() || found == maps.end()) continue;
      const MaterialId material{static_cast<std::uint32_t>(m)};
      for (const bool emits : {false, true})
        if (emits ? found->second.Ke : found->second.Kd) add({material, &found->second, emits});
    }
    for (const auto& [image, uses] : uses_) apply(uses);
    for (std::size_t k = 0; k < scene_.face_rho.size(); ++k) {
      const InputMaterial& material = scene_.materials[index(scene_.polygons[k].material)];
      if (!material.textured) scene_.face_rho[k] = material.rho;
    }
    set_mean_reflectance(scene_);
    note_factors();
  }

 private:
  void add(const MapUse& use) {
    const TextureMap& map = use.map();
    uses_[{map.image, map.beside}].push_back(use);
  }

  void apply(const std::vector<MapUse>& uses) {
    const TextureMap& map = uses.front().map();
    const std::filesystem::path* file = &map.image;
    std::optional<std::string> bytes = lookup_(*file);
    if (!bytes && map.beside != map.image) bytes = lookup_(*(file = &map.beside));
    if (!bytes || !Texture::is_known(*bytes)) {
      leave_values(uses, bytes ? fmt::format("the image '{}' is neither PNG nor JPEG", file->string())
                               : fmt::format("cannot find the image '{}'", map.image.string()));
      return;
    }
    const Texture texture = Texture::decode(*file, *bytes);
    bytes.reset();
    if (texture.has_alpha())
      scene_.notes.push_back(
          fmt::format("the image '{}' has transparent pixels, which are taken as opaque", file->string()));
    for (const MapUse& use : uses) use.emits ? set_emission(use, texture) : set_face_rho(use, texture);
  }

  void leave_values(const std::vector<MapUse>& uses, const std::string& why) {
    for (const MapUse& use : uses) {
      InputMaterial& material = scene_.materials[index(use.material)];
      if (!use.emits && !use.of->has_Kd) material.rho = Rgb(kUnknownReflectance);
      const Rgb& value = use.emits ? material.Ke : material.rho;
      scene_.notes.push_back(fmt::format("{}: material '{}' has {} {:.4g} {:.4g} {:.4g}", why, material.name,
                                         use.emits ? "Ke" : "reflectance", value.r, value.g, value.b));
    }
  }

  void set_face_rho(const MapUse& use, const Texture& texture) {
    scene_.face_rho.resize(scene_.polygons.size(), Rgb(0));
    InputMaterial& material = scene_.materials[index(use.material)];
    material.textured = true;
    const Rgb factor = use.of->has_Kd ? factor_of(material.rho, "Kd", material.name) : Rgb(1);
    for (const TexturedFace* const face : faces_[index(use.material)])
      scene_.face_rho[face->polygon] = factor * mean_of(use.map(), texture, *face);
  }

  void set_emission(const MapUse& use, const Texture& texture) {
    InputMaterial& material = scene_.materials[index(use.material)];
    Rgb sum{0};
    double whole = 0;
    for (const TexturedFace* const face : faces_[index(use.material)]) {
      const double face_area = area(scene_.polygons[face->polygon].corners);
      sum += face_area * mean_of(use.map(), texture, *face);
      whole += face_area;
    }
    material.Ke = factor_of(material.Ke, "Ke", material.name) * (whole > 0 ? sum / whole : texture.mean());
  }

  /// Exporters write 0 where the image is meant to stand alone.
  Rgb factor_of(const Rgb& value, const char* key, const std::string& material) {
    if (value != Rgb(0)) return value;
    zero_[key].push_back(material);
    return Rgb(1);
  }

  [[nodiscard]] Rgb mean_of(const TextureMap& map, const Texture& texture, const TexturedFace& face) const {
    std::vector<glm::dvec2> corners;
    for (const std::size_t corner : face.corners)
      corners.push_back(map.scale * textures_.coordinates[corner] + map.offset);
    return texture.mean_over(corners);
  }

  void note_factors() {
    for (const auto& [key, materials] : zero_) {
      scene_.notes.push_back(
          fmt::format("{}: a {} of 0, by which map_{} would be multiplied, is taken as 1 in material {}",
                      scene_.file.string(), key, key, list_names(materials)));
    }
  }

  const ObjTextures& textures_;
  const TextLookup& lookup_;
  SceneInput& scene_;
  std::vector<std::vector<const TexturedFace*>> faces_;  // of each material
  std::map<std::pair<std::filesystem::path, std::filesystem::path>, std::vector<MapUse>> uses_;  // of images
  std::map<std::string, std::vector<std::string>> zero_;  // Kd or Ke -> materials where it is 0
};

}  // namespace

void apply_textures(const std::map<std::string, MaterialMaps>& maps, const ObjTextures& textures,
                    const TextLookup& lookup, SceneInput& scene) {
  TextureApplier(textures, lookup, scene).run(maps);
}

}  // namespace fluxel
