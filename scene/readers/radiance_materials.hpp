#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "scene/readers/radiance_primitives.hpp"
#include "scene/scene_input.hpp"

namespace fluxel {

/// The modifiers of a Radiance scene, and the diffuse part of the materials among them. A name may be given
/// again: the last definition before what uses it counts.
class RadianceMaterials {
 public:
  /// `scene` takes the materials, and outlives the object.
  explicit RadianceMaterials(SceneInput& scene);

  /// Takes a primitive that is no surface. Throws InputError with file and line for unknown modifiers and
  /// for values out of range.
  void define(const RadiancePrimitive& primitive);

  /// The material of a surface; none, and counted, where it is left out. Throws InputError with file and line
  /// where its modifier is unknown.
  [[nodiscard]] std::optional<MaterialId> of_surface(const RadiancePrimitive& surface);

  /// What was not taken as it stands, for the scene's notes.
  void add_notes() const;

 private:
  /// What surfaces of a modifier are made of: a material, or one of those that are left out.
  struct Modifier {
    std::optional<MaterialId> material;
    std::size_t left_out = 0;
  };
  struct LeftOut {
    std::string material;
    std::size_t surfaces = 0;
  };

  [[nodiscard]] const Modifier& find(const RadiancePrimitive& at, const std::string& name) const;
  [[nodiscard]] Modifier resolve(const RadiancePrimitive& primitive);
  [[nodiscard]] Modifier mix(const RadiancePrimitive& mixture);
  [[nodiscard]] Modifier leave_out(const RadiancePrimitive& primitive);
  [[nodiscard]] Modifier add_material(const RadiancePrimitive& primitive);
  [[nodiscard]] Rgb reflectance(const RadiancePrimitive& primitive);
  [[nodiscard]] std::optional<Rgb> radiance(const RadiancePrimitive& primitive);
  [[nodiscard]] double fraction(const RadiancePrimitive& primitive, std::size_t real) const;
  [[nodiscard]] Rgb fractions(const RadiancePrimitive& primitive, std::size_t first) const;
  [[nodiscard]] std::string unused_name(const std::string& identifier);

  SceneInput& scene_;
  std::unordered_map<std::string, Modifier> modifiers_;
  std::unordered_map<std::string, std::size_t> definitions_;  // of each identifier
  std::unordered_set<std::string> names_;
  std::vector<LeftOut> left_out_;  // the first is `void`
  // Of notes: what was treated so.
  std::vector<std::string> patterns_, mixtures_, mirrors_, glossy_, translucent_, spotlights_, dark_glows_;
};

}  // namespace fluxel
