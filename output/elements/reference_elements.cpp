#include "output/elements/reference_elements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/input_error_at.hpp"

namespace fluxel {

namespace {

/// How far [m] a point of a patch's plane lies outside of the patch.
double distance_outside(const Patch& patch, const glm::dvec3& point) {
  double farthest = 0;
  for (std::size_t k = 0; k < patch.outline.corners; ++k) {
    const glm::dvec3& corner = patch.outline.corner[k];
    const glm::dvec3 edge = patch.outline.corner[(k + 1) % patch.outline.corners] - corner;
    const glm::dvec3 outward = glm::normalize(glm::cross(edge, patch.normal));
    farthest = std::max(farthest, glm::dot(point - corner, outward));
  }
  return farthest;
}

}  // namespace

std::vector<ElementShape> shapes_on_scene(const std::filesystem::path& file, const ElementFile& read,
                                          const Scene& scene) {
  const auto refuse = [&](const std::string& what) {
    throw input_error_at(
        file, 0, what + ": these elements are of another scene",
        "give the solution.ply of a solve of the same scene, with the same --sides and --no-cut, and with "
        "--keep-polygons where it had that or --subdivision none");
  };
  if (read.elements.outlines.empty())
    throw input_error_at(file, 0, "holds no elements", "give the solution.ply of a solve");
  // Corners were rounded to single precision about the scene's origin.
  const double tolerance = 1e-6 * scene.extent;
  std::vector<ElementShape> shapes;
  bool two_sided = false;
  for (std::size_t i = 0; i < read.elements.outlines.size(); ++i) {
    ElementShape shape{read.elements.outlines[i], read.elements.patches[i]};
    if (index(shape.patch) >= scene.patches.size())
      refuse(fmt::format("element {} lies on patch {} of {}", i, index(shape.patch), scene.patches.size()));
    const Patch& patch = scene.patch(shape.patch);
    for (std::size_t k = 0; k < shape.outline.corners; ++k) {
      shape.outline.corner[k] -= scene.origin;
      const double distance = glm::dot(shape.outline.corner[k] - patch.outline.corner[0], patch.normal);
      if (!(std::abs(distance) <= tolerance))
        refuse(fmt::format("element {} is {:.3g} m off the plane of its patch {}", i, std::abs(distance),
                           index(shape.patch)));
      const double outside = distance_outside(patch, shape.outline.corner[k]);
      if (!(outside <= tolerance))
        refuse(
            fmt::format("element {} reaches {:.3g} m beyond its patch {}", i, outside, index(shape.patch)));
    }
    two_sided = two_sided || (patch.sides & kBack) != 0;
    shapes.push_back(shape);
  }
  if (read.layers.contains(kRadiosityBack) != two_sided)
    refuse(two_sided ? "it has no backs, and the scene has" : "it has backs, and the scene has none");
  return shapes;
}

}  // namespace fluxel
