#include "subdivision/add_element.hpp"

#include "core/second_moments.hpp"

namespace fluxel {

Element make_element(const Scene& scene, PatchId id, const Outline3& outline) {
  const Patch& patch = scene.patch(id);
  Element element;
  element.centroid = glm::vec3(centroid(outline));
  element.area = static_cast<float>(area(outline));
  element.normal = glm::vec3(patch.normal);
  element.patch = id;
  element.material = patch.material;
  element.sides = patch.sides;
  const SecondMoments moments = second_moments(outline);
  element.elongation = glm::vec3(moments.elongation);
  element.minor_variance = static_cast<float>(moments.minor_variance);
  return element;
}

Outline<glm::vec3> narrow(const Outline3& outline) {
  Outline<glm::vec3> single;
  single.corners = outline.corners;
  for (std::size_t c = 0; c < outline.corners; ++c) single.corner[c] = glm::vec3(outline.corner[c]);
  return single;
}

void add_element(const Scene& scene, PatchId id, const Outline3& outline, ElementMesh& mesh) {
  mesh.elements.push_back(make_element(scene, id, outline));
  mesh.outlines.push_back(narrow(outline));
}

}  // namespace fluxel
