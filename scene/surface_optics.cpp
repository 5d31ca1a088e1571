#include "scene/surface_optics.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/input_error_at.hpp"
#include "scene/contact_pairs.hpp"
#include "scene/polygon.hpp"
#include "scene/sealed_sides.hpp"

namespace fluxel {

namespace {

/// Off a patch, to tell its sides apart [contact tolerances].
constexpr double kOffFace = 10;

std::string unlike_diffuse(const SurfaceOptics& optics) {
  if (optics.bounds_clear_body()) return "refraction_index";
  if (optics.mirror != Rgb(0)) return "mirror";
  return optics.transmission != Rgb(0) ? "transmission" : "diffuse_transmission";
}

}  // namespace

void refuse_specular(const InputMaterial& material, const std::filesystem::path& file) {
  throw input_error_at(
      file, material.optics_line,
      fmt::format("material '{}' does more than reflect evenly ({})", material.name,
                  unlike_diffuse(material.optics)),
      "this method knows diffuse surfaces alone: 'fluxel photons' and 'fluxel reference' know it; --specular "
      "absorb takes it as black but for rho");
}

void require_clear_bodies(const Scene& scene, const PatchMesh& mesh, const SceneInput& input) {
  const auto material_of = [&](PatchId id) { return index(scene.patch(id).material); };
  const auto is_clear = [&](PatchId id) {
    return scene.material(scene.patch(id)).optics.bounds_clear_body();
  };
  const auto refuse = [&](PatchId id, const std::string& what, const std::string& hint) {
    const std::string& name = scene.material(scene.patch(id)).name;
    std::size_t line = 0;
    for (const InputMaterial& material : input.materials)
      if (material.name == name) line = material.optics_line;
    throw input_error_at(input.file, line,
                         fmt::format("material '{}' has a refraction_index, and {} (group '{}')", name, what,
                                     scene.groups[index(scene.patch(id).group)]),
                         hint);
  };
  std::vector<const PatchComponent*> bodies;
  for (const PatchComponent& component : mesh.components) {
    PatchId first = kNoPatch;
    for (const PatchId id : component.patches) {
      if (!is_clear(id)) continue;
      if (first == kNoPatch) first = id;
      if (material_of(id) != material_of(first))
        refuse(id, "touches another clear material along an edge",
               "between clear bodies there has to be air, or they have to be one");
    }
    if (first == kNoPatch) continue;
    if (!component.closed || !component.oriented)
      refuse(first, component.closed ? "its surface's normals do not agree" : "its surface has an open edge",
             "a clear body has to be closed, its faces' corners counter-clockwise as seen from outside; a "
             "single pane is transmission = ... without refraction");
    bodies.push_back(&component);
  }
  // How often clear bodies wind around either side of a face: once within, not at all without.
  const double lift = kOffFace * contact_tolerance(scene);
  const auto winding = [&](const glm::dvec3& x) {
    double sum = 0;
    for (const PatchComponent* const body : bodies) sum += winding_number(scene, *body, x);
    return std::lround(sum);
  };
  for (const PatchComponent* const body : bodies)
    for (const PatchId id : body->patches) {
      if (!is_clear(id)) continue;
      const Patch& patch = scene.patch(id);
      const glm::dvec3 x = centroid(corners(patch.outline)), step = lift * patch.normal;
      const long before = winding(x + step), behind = winding(x - step);
      if (before == 0 && behind == 1) break;
      if (behind > 1)
        refuse(id, "lies within another clear body", "between clear bodies there has to be air");
      refuse(id, "its normals point inwards",
             "turn its faces around: their corners run counter-clockwise as seen from outside");
    }
}

}  // namespace fluxel
