#include "scene/readers/radiance_materials.hpp"

#include <fmt/format.h>

#include <numbers>
#include <utility>

#include "core/input_error_at.hpp"
#include "scene/list_names.hpp"
#include "scene/readers/statements.hpp"

namespace fluxel {
namespace {

constexpr double kMaxRadiance = 1e14;  // [W/(m2 sr)], far above any light

std::string described(const RadiancePrimitive& primitive) {
  return fmt::format("{} {} (line {})", primitive.type->name, in_quotes(primitive.identifier),
                     primitive.line);
}

Rgb triple(const RadiancePrimitive& primitive, std::size_t first) {
  return {primitive.reals[first], primitive.reals[first + 1], primitive.reals[first + 2]};
}

bool same_values(const InputMaterial& a, const InputMaterial& b) { return a.rho == b.rho && a.E == b.E; }

}  // namespace

RadianceMaterials::RadianceMaterials(SceneInput& scene) : scene_(scene), left_out_{{"void"}} {
  modifiers_["void"] = {};
}

void RadianceMaterials::define(const RadiancePrimitive& primitive) {
  modifiers_[primitive.identifier] = resolve(primitive);
}

std::optional<MaterialId> RadianceMaterials::of_surface(const RadiancePrimitive& surface) {
  const Modifier modifier = find(surface, surface.modifier);
  if (!modifier.material) ++left_out_[modifier.left_out].surfaces;
  return modifier.material;
}

void RadianceMaterials::add_notes() const {
  const auto note = [&](const char* what, const std::vector<std::string>& where) {
    if (!where.empty())
      scene_.notes.push_back(fmt::format("{}: {}: {}", scene_.file.string(), what, list_names(where)));
  };
  std::vector<std::string> absent;
  for (const LeftOut& material : left_out_)
    if (material.surfaces > 0)
      absent.push_back(fmt::format("{} of {}", material.surfaces, material.material));
  note("surfaces are left out, as light passes them", absent);
  note("patterns and textures are ignored", patterns_);
  note("mixtures are taken as the first material that they mix", mixtures_);
  note("the whole reflectance is taken as diffuse", mirrors_);
  note("only the diffuse part of the reflectance is taken", glossy_);
  note("transmitted light is lost", translucent_);
  note("spotlights emit in all directions", spotlights_);
  note("does not emit, since its radius is negative", dark_glows_);
}

const RadianceMaterials::Modifier& RadianceMaterials::find(const RadiancePrimitive& at,
                                                           const std::string& name) const {
  const auto found = modifiers_.find(name);
  if (found != modifiers_.end()) return found->second;
  throw input_error_at(scene_.file, at.line,
                       fmt::format("{} {} names an unknown modifier {}", at.type->name,
                                   in_quotes(at.identifier), in_quotes(name)),
                       "it must be defined in the same file, before it is used");
}

RadianceMaterials::Modifier RadianceMaterials::resolve(const RadiancePrimitive& primitive) {
  using enum RadianceRole;
  const bool inherits = primitive.type->role == alias && primitive.modifier == "inherit";
  const Modifier below = inherits ? Modifier{} : find(primitive, primitive.modifier);
  switch (primitive.type->role) {
    case alias:
      return find(primitive, primitive.strings.front());
    case pattern:
      patterns_.push_back(described(primitive));
      return below;
    case mixture:
      mixtures_.push_back(described(primitive));
      return mix(primitive);
    case transparent:
      return leave_out(primitive);
    default:
      return add_material(primitive);
  }
}

/// A mixture of patterns is of the material below.
RadianceMaterials::Modifier RadianceMaterials::mix(const RadiancePrimitive& mixture) {
  if (mixture.strings.size() < 2) {
    throw input_error_at(scene_.file, mixture.line,
                         fmt::format("{} {} has {} string arguments", mixture.type->name,
                                     in_quotes(mixture.identifier), mixture.strings.size()),
                         "the first two are what it mixes");
  }
  for (const std::string& name : {mixture.strings[0], mixture.strings[1]})
    if (const Modifier modifier = find(mixture, name); modifier.material) return modifier;
  return find(mixture, mixture.modifier);
}

RadianceMaterials::Modifier RadianceMaterials::leave_out(const RadiancePrimitive& primitive) {
  left_out_.push_back({described(primitive)});
  return {{}, left_out_.size() - 1};
}

/// A definition with the values of the one before is the same material: files that are joined often repeat
/// them.
RadianceMaterials::Modifier RadianceMaterials::add_material(const RadiancePrimitive& primitive) {
  InputMaterial material;
  material.rho = reflectance(primitive);
  if (const std::optional<Rgb> L = radiance(primitive)) {
    material.E = std::numbers::pi * *L;
    scene_.units = Units::radiometric;
  }
  material.sides = Sides::two;
  const auto before = modifiers_.find(primitive.identifier);
  if (before != modifiers_.end() && before->second.material &&
      same_values(scene_.materials[index(*before->second.material)], material))
    return before->second;
  material.name = unused_name(primitive.identifier);
  scene_.materials.push_back(std::move(material));
  return {MaterialId{static_cast<std::uint32_t>(scene_.materials.size() - 1)}, 0};
}

/// The diffuse part (Ward, section 2.1.2; Ward Larson and Shakespeare, Rendering with Radiance, 1998,
/// chapter 5).
Rgb RadianceMaterials::reflectance(const RadiancePrimitive& primitive) {
  using enum RadianceRole;
  switch (primitive.type->role) {
    case plastic: {
      const double specular = fraction(primitive, 3);
      if (specular > 0) glossy_.push_back(described(primitive));
      return fractions(primitive, 0) * (1 - specular);
    }
    case trans: {
      const double reflected = 1 - fraction(primitive, primitive.type->transmissivity);
      translucent_.push_back(described(primitive));
      return fractions(primitive, 0) * (1 - fraction(primitive, 3)) * reflected;
    }
    case ashik:
      glossy_.push_back(described(primitive));
      return fractions(primitive, 0) * (Rgb(1) - fractions(primitive, 3));
    case brtd:
      glossy_.push_back(described(primitive));
      return fractions(primitive, 0);
    case metal:
    case mirror:
      mirrors_.push_back(described(primitive));
      return fractions(primitive, 0);
    case illum:
      if (!primitive.strings.empty())
        if (const Modifier seen = find(primitive, primitive.strings.front()); seen.material)
          return scene_.materials[index(*seen.material)].rho;
      return Rgb(0);
    default:
      return Rgb(0);  // lights reflect nothing
  }
}

std::optional<Rgb> RadianceMaterials::radiance(const RadiancePrimitive& primitive) {
  using enum RadianceRole;
  const RadianceRole role = primitive.type->role;
  if (role != light && role != illum && role != glow && role != spotlight) return std::nullopt;
  const Rgb L = triple(primitive, 0);
  for (int c = 0; c < kChannels; ++c) {
    if (L[c] >= 0 && L[c] <= kMaxRadiance) continue;
    throw input_error_at(scene_.file, primitive.line,
                         fmt::format("radiance {} of {} {} is {}", L[c], primitive.type->name,
                                     in_quotes(primitive.identifier), L[c] < 0 ? "negative" : "too large"));
  }
  if (role == spotlight) spotlights_.push_back(described(primitive));
  if (role == glow && primitive.reals[3] < 0) {
    dark_glows_.push_back(described(primitive));
    return std::nullopt;
  }
  return L;
}

double RadianceMaterials::fraction(const RadiancePrimitive& primitive, std::size_t real) const {
  const double value = primitive.reals[real];
  if (value >= 0 && value <= 1) return value;
  throw input_error_at(scene_.file, primitive.line,
                       fmt::format("{} {}: real argument {} is {}, outside 0..1", primitive.type->name,
                                   in_quotes(primitive.identifier), real + 1, value));
}

Rgb RadianceMaterials::fractions(const RadiancePrimitive& primitive, std::size_t first) const {
  return {fraction(primitive, first), fraction(primitive, first + 1), fraction(primitive, first + 2)};
}

/// `wall`, then `wall (2)` and so on.
std::string RadianceMaterials::unused_name(const std::string& identifier) {
  std::string name = identifier;
  std::size_t& definitions = definitions_[identifier];
  if (++definitions > 1) name = fmt::format("{} ({})", identifier, definitions);
  while (!names_.insert(name).second) name = fmt::format("{} ({})", identifier, ++definitions);
  return name;
}

}  // namespace fluxel
