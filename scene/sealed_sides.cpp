#include "scene/sealed_sides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <vector>

#include "scene/contact_pairs.hpp"
#include "scene/polygon.hpp"

namespace fluxel {
namespace {

double solid_angle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  const double triple = glm::dot(a, glm::cross(b, c));
  const double below = la * lb * lc + glm::dot(a, b) * lc + glm::dot(a, c) * lb + glm::dot(b, c) * la;
  return 2 * std::atan2(triple, below);
}

/// What a closed component encloses, and its box.
struct Enclosure {
  Enclosure(const Scene& scene, const PatchComponent& component) {
    const glm::dvec3 origin = scene.patch(component.patches[0]).outline.corner[0];
    for (const PatchId id : component.patches) {
      const PolygonView outline = corners(scene.patch(id).outline);
      const glm::dvec3 patch_area = area_vector(outline);
      volume += glm::dot(outline[0] - origin, patch_area) / 3;
      area += glm::length(patch_area);
      for (const glm::dvec3& x : outline) {
        low = glm::min(low, x);
        high = glm::max(high, x);
      }
    }
  }
  [[nodiscard]] bool box_holds(const glm::dvec3& x) const { return glm::clamp(x, low, high) == x; }

  double volume = 0;  ///< [m3], positive where the normals point outward
  double area = 0;    ///< [m2]
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-low};
};

bool lets_light_in(const Scene& scene, const PatchComponent& component) {
  return std::ranges::any_of(component.patches, [&](PatchId id) {
    return scene.material(scene.patch(id)).optics.lets_light_through();
  });
}

bool shines_back(const Scene& scene, const Luminaire& luminaire) {
  if (luminaire.intensity >= scene.intensities.size()) return false;
  const IntensityTable& table = scene.intensities[luminaire.intensity];
  for (std::size_t g = 0; g < table.gamma.size(); ++g)
    for (std::size_t c = 0; c < table.C.size(); ++c)
      if (table.gamma[g] > 0.5 * std::numbers::pi && table.at(c, g) > 0) return true;
  return false;
}

}  // namespace

double winding_number(const Scene& scene, const PatchComponent& component, const glm::dvec3& point) {
  double sum = 0;
  for (const PatchId id : component.patches) {
    const PolygonView outline = corners(scene.patch(id).outline);
    for (std::size_t i = 2; i < outline.size(); ++i) {
      sum += solid_angle(outline[0] - point, outline[i - 1] - point, outline[i] - point);
    }
  }
  return sum / (4 * std::numbers::pi);
}

std::vector<bool> patches_of_bodies(const Scene& scene, const PatchMesh& mesh) {
  const double tolerance = contact_tolerance(scene);
  std::vector<bool> found(scene.patches.size(), false);
  for (const PatchComponent& component : mesh.components) {
    if (!component.closed || !component.oriented) continue;
    const Enclosure enclosure(scene, component);
    if (!(enclosure.volume > 0.5 * tolerance * enclosure.area)) continue;
    for (const PatchId id : component.patches) found[index(id)] = true;
  }
  return found;
}

void leave_out_sealed_sides(Scene& scene, const PatchMesh& mesh, std::optional<glm::dvec3> camera_eye) {
  const double tolerance = contact_tolerance(scene);
  // Where light or eyes are: what a component encloses is sealed where it encloses none of these.
  std::vector<glm::dvec3> lit;
  for (const Piece& piece : scene.pieces) {
    const Patch& patch = scene.patch(piece.patch);
    const glm::dvec3 middle = centroid(corners(piece.outline)), step = 10 * tolerance * patch.normal;
    if (scene.emits(piece.patch)) lit.push_back(middle + step);
    if ((patch.sides & kBack) != 0 && scene.material(patch).back_exitance() != Rgb(0))
      lit.push_back(middle - step);
  }
  // One in a ceiling lights what is below it, and what is above where it shines back.
  for (const Luminaire& luminaire : scene.luminaires) {
    lit.push_back(luminaire.position + 10 * tolerance * luminaire.aim);
    if (shines_back(scene, luminaire)) lit.push_back(luminaire.position - 10 * tolerance * luminaire.aim);
  }
  if (camera_eye) lit.push_back(*camera_eye - scene.origin);

  std::size_t sealed_components = 0, sealed_sides = 0;
  for (const PatchComponent& component : mesh.components) {
    if (!component.closed || !component.oriented || lets_light_in(scene, component)) continue;
    const Enclosure enclosure(scene, component);
    // The sign of a volume thinner than the tolerance is rounding.
    if (std::abs(enclosure.volume) <= 0.5 * tolerance * enclosure.area) continue;
    const bool outward = enclosure.volume > 0;
    if (std::any_of(lit.begin(), lit.end(), [&](const glm::dvec3& x) {
          return enclosure.box_holds(x) && std::abs(winding_number(scene, component, x)) > 0.5;
        })) {
      continue;
    }
    std::size_t sides = 0;
    for (const PatchId id : component.patches) {
      Patch& patch = scene.patches[index(id)];
      if (patch.sides != (kFront | kBack)) continue;
      patch.sides = outward ? kFront : kBack;
      ++sides;
    }
    sealed_sides += sides;
    if (sides > 0) ++sealed_components;
  }
  scene.statistics.sealed_sides = sealed_sides;
  if (sealed_sides > 0) {
    scene.notes.push_back(
        fmt::format("{} sides look into {} closed {} with no light and no camera inside and are "
                    "left out",
                    sealed_sides, sealed_components, sealed_components == 1 ? "component" : "components"));
  }
}

}  // namespace fluxel
