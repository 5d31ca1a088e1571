#include "output/element_mesh_to_show.hpp"

#include <algorithm>
#include <limits>

namespace fluxel {

namespace {

MeshToShow named(const Scene& scene, const glm::dvec3& up) {
  MeshToShow shown;
  shown.groups = scene.groups;
  for (const Material& material : scene.materials) {
    shown.materials.push_back(material.name);
    shown.reflectance.push_back(material.rho);
  }
  shown.up = up;
  return shown;
}

void add_element(const Scene& scene, PatchId patch, MeshToShow& shown) {
  shown.patch.push_back(static_cast<std::uint32_t>(index(patch)));
  shown.group.push_back(static_cast<std::uint32_t>(index(scene.patch(patch).group)));
  shown.material.push_back(static_cast<std::uint32_t>(index(scene.patch(patch).material)));
}

}  // namespace

MeshToShow mesh_to_show(const Scene& scene, const ElementView& mesh, const glm::dvec3& up) {
  MeshToShow shown = named(scene, up);
  shown.outlines.assign(mesh.outlines.begin(), mesh.outlines.end());
  for (const Element& element : mesh.elements) add_element(scene, element.patch, shown);
  return shown;
}

MeshToShow mesh_to_show(const Scene& scene, const FileElements& elements, const glm::dvec3& up) {
  MeshToShow shown = named(scene, up);
  for (std::size_t k = 0; k < elements.outlines.size(); ++k) {
    Outline<glm::vec3> outline;
    outline.corners = elements.outlines[k].corners;
    for (std::size_t c = 0; c < outline.corners; ++c)
      outline.corner[c] = glm::vec3(elements.outlines[k].corner[c] - scene.origin);
    shown.outlines.push_back(outline);
    add_element(scene, elements.patches[k], shown);
  }
  return shown;
}

void add_sides(const ElementView& mesh, const std::string& name, std::span<const Rgb> fronts,
               std::span<const Rgb> backs, MeshToShow& shown) {
  const auto add = [&](const std::string& layer, std::span<const Rgb> values, std::uint32_t side) {
    std::vector<Rgb> known;
    known.reserve(values.size());
    for (std::size_t k = 0; k < values.size(); ++k)
      known.push_back((mesh.elements[k].sides & side) != 0 ? values[k]
                                                           : Rgb(std::numeric_limits<double>::quiet_NaN()));
    shown.layers.push_back(layer_of(layer, known));
  };
  add(name, fronts, kFront);
  if (std::ranges::any_of(mesh.elements, [](const Element& element) { return (element.sides & kBack) != 0; }))
    add(name + "_back", backs, kBack);
}

}  // namespace fluxel
