#include "scene/readers/gltf_notes.hpp"

#include <fmt/format.h>
#include <tiny_gltf.h>

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

bool is_unknown(const std::string& extension) {
  return std::ranges::find(kRead, extension) == kRead.end() &&
         std::ranges::find(kAppearance, extension) == kAppearance.end();
}

std::vector<std::string> unknown_of(const std::vector<std::string>& extensions) {
  std::vector<std::string> unknown;
  for (const std::string& extension : extensions) {
    if (is_unknown(extension)) unknown.push_back(in_quotes(extension));
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

template <class Elements, class Predicate>
std::size_t count_if(const Elements& elements, const Predicate& predicate) {
  return static_cast<std::size_t>(std::ranges::count_if(elements, predicate));
}

void note_materials(const tinygltf::Model& model, Notes& notes) {
  using tinygltf::Material;
  const std::vector<Material>& materials = model.materials;
  notes.add(count_if(materials,
                     [](const Material& m) {
                       return !m.values.contains("baseColorFactor") && !m.values.contains("baseColorTexture");
                     }),
            "materials have no base colour, so reflectance 1");
  // Without any metallic-roughness values the factor's default of 1 is nobody's intention.
  notes.add(count_if(materials,
                     [](const Material& m) {
                       return !m.values.empty() && m.pbrMetallicRoughness.metallicFactor > 0;
                     }),
            "metallic materials taken as diffuse, their base colour as reflectance");
  notes.add(count_if(materials, [](const Material& m) { return m.alphaMode != "OPAQUE"; }),
            "materials of alphaMode MASK or BLEND, opaque unless a scene file says more");
  notes.add(count_if(materials, [](const Material& m) { return m.normalTexture.index >= 0; }),
            "materials have a normalTexture, taken as smooth");
  notes.add(count_if(materials, [](const Material& m) { return m.occlusionTexture.index >= 0; }),
            "materials have an occlusionTexture, left out: occlusion is computed");
  notes.add(
      count_if(materials,
               [](const Material& m) { return m.pbrMetallicRoughness.metallicRoughnessTexture.index >= 0; }),
      "materials have a metallicRoughnessTexture, taken as diffuse");
  notes.add(count_if(materials, [](const Material& m) { return m.emissiveTexture.index >= 0; }),
            "materials have an emissiveTexture, of which each emits its mean");
  for (const std::string_view extension : kAppearance) {
    const std::string name(extension);
    notes.add(count_if(materials, [&](const Material& m) { return m.extensions.contains(name); }),
              fmt::format("materials have {}, diffuse and opaque without it unless a scene file says more",
                          extension));
  }
}

void note_meshes(const tinygltf::Model& model, Notes& notes) {
  std::size_t targets = 0, colours = 0;
  for (const tinygltf::Mesh& mesh : model.meshes) {
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      targets += primitive.targets.empty() ? 0 : 1;
      colours += primitive.attributes.contains("COLOR_0") ? 1 : 0;
    }
  }
  notes.add(targets, "primitives have morph targets, taken without them");
  notes.add(colours, "primitives have colours of vertices, left out");
}

void note_nodes(const tinygltf::Model& model, const std::vector<GltfNode>& nodes, Notes& notes) {
  std::size_t orthographic = 0, ranges = 0;
  for (const GltfNode& node : nodes) {
    const tinygltf::Node& given = model.nodes[node.node];
    if (given.camera >= 0 && model.cameras[static_cast<std::size_t>(given.camera)].type == "orthographic")
      ++orthographic;
    const auto light = given.extensions.find("KHR_lights_punctual");
    if (light != given.extensions.end() &&
        model.lights[static_cast<std::size_t>(light->second.Get("light").GetNumberAsInt())].range > 0)
      ++ranges;
  }
  notes.add(orthographic, "orthographic cameras are left out");
  notes.add(ranges, "lights have a range, which is ignored: light has none");
}

}  // namespace

void require_known_extensions(const GltfFile& gltf) {
  const std::vector<std::string> unknown = unknown_of(gltf.model->extensionsRequired);
  if (!unknown.empty()) {
    throw gltf.error("extensionsRequired", "the file cannot be read without " + list_names(unknown),
                     "export it without, as uncompressed glTF 2.0");
  }
}

std::vector<std::string> gltf_notes(const GltfFile& gltf, const std::vector<GltfNode>& nodes) {
  const tinygltf::Model& model = *gltf.model;
  Notes notes(gltf.path);
  const std::vector<std::string> unknown = unknown_of(model.extensionsUsed);
  if (!unknown.empty()) notes.add(fmt::format("extensions that are not read: {}", list_names(unknown)));
  if (model.scenes.size() > 1)
    notes.add(model.scenes.size() - 1, "scenes beside the default one are left out");
  notes.add(gltf.document.animations, "animations are left out");
  notes.add(gltf.document.skins, "skins are left out, their meshes taken at rest");
  note_materials(model, notes);
  notes.add(count_if(model.samplers,
                     [](const tinygltf::Sampler& s) {
                       return s.wrapS != TINYGLTF_TEXTURE_WRAP_REPEAT ||
                              s.wrapT != TINYGLTF_TEXTURE_WRAP_REPEAT;
                     }),
            "samplers clamp or mirror images, which are taken to repeat");
  note_meshes(model, notes);
  note_nodes(model, nodes, notes);
  return notes.take();
}

}  // namespace fluxel
