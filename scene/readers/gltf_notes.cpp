#include "scene/readers/gltf_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "scene/list_names.hpp"
#include "scene/readers/statements.hpp"

namespace fluxel {
namespace {

constexpr std::array<std::string_view, 4> kRead{"KHR_lights_punctual", "KHR_materials_emissive_strength",
                                                "KHR_mesh_quantization", "KHR_texture_transform"};

/// What a material is beside a diffuse surface.
constexpr std::array<std::string_view, 12> kAppearance{
    "KHR_materials_anisotropy", "KHR_materials_clearcoat", "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion", "KHR_materials_ior",       "KHR_materials_iridescence",
    "KHR_materials_sheen",      "KHR_materials_specular",  "KHR_materials_transmission",
    "KHR_materials_unlit",      "KHR_materials_variants",  "KHR_materials_volume"};

constexpr std::size_t kRepeat = 10497;  // how a sampler wraps, as a number of OpenGL

bool is_unknown(std::string_view extension) {
  return std::ranges::find(kRead, extension) == kRead.end() &&
         std::ranges::find(kAppearance, extension) == kAppearance.end();
}

std::vector<std::string> unknown_of(const GltfValue& extensions) {
  std::vector<std::string> unknown;
  for (std::size_t k = 0; k < extensions.size(); ++k) {
    if (is_unknown(extensions[k].text())) unknown.push_back(in_quotes(extensions[k].text()));
  }
  return unknown;
}

/// Collects notes about things of which there are some.
class Notes {
 public:
  explicit Notes(const std::filesystem::path& file) : file_(file.string()) {}

  /// `what` begins with the kind of things, in the plural.
  void add(std::size_t count, std::string_view what) {
    if (count > 0) notes_.push_back(fmt::format("{}: {} ({})", file_, what, count));
  }
  void add(const std::string& what) { notes_.push_back(fmt::format("{}: {}", file_, what)); }

  std::vector<std::string> take() { return std::move(notes_); }

 private:
  std::string file_;
  std::vector<std::string> notes_;
};

template <class Predicate>
std::size_t count_if(const GltfValue& array, const Predicate& predicate) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < array.size(); ++k) count += predicate(array[k]) ? 1 : 0;
  return count;
}

std::size_t count_with(const GltfValue& array, std::string_view key) {
  return count_if(array, [key](const GltfValue& element) { return element[key].given(); });
}

void note_materials(const GltfValue& materials, Notes& notes) {
  notes.add(count_if(materials,
                     [](const GltfValue& m) {
                       const GltfValue values = m["pbrMetallicRoughness"];
                       return !values["baseColorFactor"].given() && !values["baseColorTexture"].given();
                     }),
            "materials have no base colour, so reflectance 1");
  // Without any metallic-roughness values the factor's default of 1 is nobody's intention.
  notes.add(count_if(materials,
                     [](const GltfValue& m) {
                       const GltfValue values = m["pbrMetallicRoughness"];
                       return values.size() > 0 && values["metallicFactor"].number(1) > 0;
                     }),
            "metallic materials taken as diffuse, their base colour as reflectance");
  notes.add(count_if(materials, [](const GltfValue& m) { return m["alphaMode"].text("OPAQUE") != "OPAQUE"; }),
            "materials of alphaMode MASK or BLEND, opaque unless a scene file says more");
  notes.add(count_with(materials, "normalTexture"), "materials have a normalTexture, taken as smooth");
  notes.add(count_with(materials, "occlusionTexture"),
            "materials have an occlusionTexture, left out: occlusion is computed");
  notes.add(count_if(materials,
                     [](const GltfValue& m) {
                       return m["pbrMetallicRoughness"]["metallicRoughnessTexture"].given();
                     }),
            "materials have a metallicRoughnessTexture, taken as diffuse");
  notes.add(count_with(materials, "emissiveTexture"),
            "materials have an emissiveTexture, of which each emits its mean");
  for (const std::string_view extension : kAppearance) {
    notes.add(count_if(materials, [&](const GltfValue& m) { return m["extensions"][extension].given(); }),
              fmt::format("materials have {}, diffuse and opaque without it unless a scene file says more",
                          extension));
  }
}

void note_meshes(const GltfValue& meshes, Notes& notes) {
  std::size_t targets = 0, colours = 0;
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    const GltfValue primitives = meshes[k]["primitives"];
    targets += count_if(primitives, [](const GltfValue& p) { return p["targets"].size() > 0; });
    colours += count_if(primitives, [](const GltfValue& p) { return p["attributes"]["COLOR_0"].given(); });
  }
  notes.add(targets, "primitives have morph targets, taken without them");
  notes.add(colours, "primitives have colours of vertices, left out");
}

void note_nodes(const GltfFile& gltf, const std::vector<GltfNode>& nodes, Notes& notes) {
  const GltfValue cameras = gltf["cameras"], lights = gltf["extensions"]["KHR_lights_punctual"]["lights"];
  std::size_t orthographic = 0, ranges = 0;
  for (const GltfNode& node : nodes) {
    const GltfValue given = gltf["nodes"][node.node];
    const GltfValue camera = given["camera"], light = given["extensions"]["KHR_lights_punctual"]["light"];
    if (camera.given() && cameras[camera.whole()]["type"].text() == "orthographic") ++orthographic;
    if (light.given() && lights[light.whole()]["range"].number(0) > 0) ++ranges;
  }
  notes.add(orthographic, "orthographic cameras are left out");
  notes.add(ranges, "lights have a range, which is ignored: light has none");
}

}  // namespace

void require_known_extensions(const GltfFile& gltf) {
  const std::vector<std::string> unknown = unknown_of(gltf["extensionsRequired"]);
  if (!unknown.empty()) {
    throw gltf.error("extensionsRequired", "the file cannot be read without " + list_names(unknown),
                     "export it without, as uncompressed glTF 2.0");
  }
}

std::vector<std::string> gltf_notes(const GltfFile& gltf, const std::vector<GltfNode>& nodes) {
  Notes notes(gltf.path);
  const std::vector<std::string> unknown = unknown_of(gltf["extensionsUsed"]);
  if (!unknown.empty()) notes.add(fmt::format("extensions that are not read: {}", list_names(unknown)));
  const std::size_t scenes = gltf["scenes"].size();
  if (scenes > 1) notes.add(scenes - 1, "scenes beside the default one are left out");
  notes.add(gltf["animations"].size(), "animations are left out");
  notes.add(gltf["skins"].size(), "skins are left out, their meshes taken at rest");
  note_materials(gltf["materials"], notes);
  notes.add(count_if(gltf["samplers"],
                     [](const GltfValue& s) {
                       return s["wrapS"].whole(kRepeat) != kRepeat || s["wrapT"].whole(kRepeat) != kRepeat;
                     }),
            "samplers clamp or mirror images, which are taken to repeat");
  note_meshes(gltf["meshes"], notes);
  note_nodes(gltf, nodes, notes);
  return notes.take();
}

}  // namespace fluxel
