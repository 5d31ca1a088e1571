#include "scene/closedness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <vector>

#include "scene/contact_pairs.hpp"
#include "scene/polygon.hpp"
#include "scene/sealed_sides.hpp"

namespace fluxel {
namespace {

/// Patches and boxes that are looked at before giving up: some seconds.
constexpr std::size_t kMaxTests = 50'000'000;
constexpr int kDirections = 32;

/// Directions that are even over the sphere, a spiral of golden angles (Gonzalez 2010).
glm::dvec3 even_direction(int k) {
  const double z = 1 - (2 * k + 1.0) / kDirections, r = std::sqrt(1 - z * z);
  const double angle = k * std::numbers::pi * (3 - std::sqrt(5.0));
  return {r * std::cos(angle), r * std::sin(angle), z};
}

bool ray_meets_patch(const Patch& patch, const glm::dvec3& from, const glm::dvec3& direction) {
  const PolygonView outline = corners(patch.outline);
  const double approach = glm::dot(patch.normal, direction);
  const double t = glm::dot(patch.normal, outline[0] - from) / approach;
  if (approach == 0 || t <= 0) return false;
  const glm::dvec3 at = from + t * direction;
  for (std::size_t edge = 0; edge < outline.size(); ++edge) {
    if (edge_plane(outline, edge, patch.normal).distance(at) < 0) return false;
  }
  return true;
}

/// A component without free edges, and its box.
class ClosedBody {
 public:
  ClosedBody(const Scene& scene, const PatchComponent& component) : scene_(&scene), component_(&component) {
    for (const PatchId id : component.patches) {
      for (const glm::dvec3& x : corners(scene.patch(id).outline)) {
        low_ = glm::min(low_, x);
        high_ = glm::max(high_, x);
      }
    }
  }

  [[nodiscard]] double size() const { return glm::distance(low_, high_); }

  /// By the winding number where there is one: it tells a point in a narrow bay from one within.
  [[nodiscard]] bool holds(const glm::dvec3& x, std::size_t& tests) const {
    ++tests;
    if (glm::clamp(x, low_, high_) != x) return false;
    tests += component_->patches.size() * (component_->oriented ? 1 : kDirections);
    if (component_->oriented) return std::abs(winding_number(*scene_, *component_, x)) > 0.5;
    for (int k = 0; k < kDirections; ++k) {
      const glm::dvec3 direction = even_direction(k);
      if (std::ranges::none_of(component_->patches,
                               [&](PatchId id) { return ray_meets_patch(scene_->patch(id), x, direction); }))
        return false;
    }
    return true;
  }

 private:
  const Scene* scene_;
  const PatchComponent* component_;
  glm::dvec3 low_{std::numeric_limits<double>::infinity()}, high_{-low_};
};

/// Its centroid, and its corners moved a hundredth of the way there: an edge may lie on a wall.
std::vector<glm::dvec3> points_of(const Patch& patch) {
  const PolygonView outline = corners(patch.outline);
  std::vector<glm::dvec3> points{centroid(outline)};
  for (const glm::dvec3& x : outline) points.push_back(x + 0.01 * (points[0] - x));
  return points;
}

/// The outer shell first: it is the one that holds most.
std::vector<ClosedBody> closed_bodies(const Scene& scene, const PatchMesh& mesh) {
  std::vector<ClosedBody> bodies;
  for (const PatchComponent& component : mesh.components) {
    if (component.closed) bodies.emplace_back(scene, component);
  }
  std::ranges::sort(bodies, std::ranges::greater{}, &ClosedBody::size);
  return bodies;
}

/// Off a patch, to tell its sides apart [contact tolerances].
constexpr double kLift = 10;

}  // namespace

bool is_closed(const Scene& scene, const PatchMesh& mesh) {
  const std::vector<ClosedBody> bodies = closed_bodies(scene, mesh);
  std::size_t tests = 0;
  const double lift = kLift * contact_tolerance(scene);
  const auto held = [&](const Patch& patch, const glm::dvec3& x) {
    return std::ranges::any_of(bodies, [&](const ClosedBody& body) {
      return body.holds(x + lift * patch.normal, tests) || body.holds(x - lift * patch.normal, tests);
    });
  };
  for (const PatchComponent& component : mesh.components) {
    if (component.closed) continue;
    for (const PatchId id : component.patches) {
      const Patch& patch = scene.patch(id);
      for (const glm::dvec3& x : points_of(patch)) {
        if (tests > kMaxTests || !held(patch, x)) return false;
      }
    }
  }
  return true;
}

bool is_lit_inside(const Scene& scene, const PatchMesh& mesh) {
  const std::vector<ClosedBody> bodies = closed_bodies(scene, mesh);
  std::size_t tests = 0;
  const double lift = kLift * contact_tolerance(scene);
  return std::ranges::any_of(scene.patches, [&](const Patch& patch) {
    if (!scene.material(patch).emits()) return false;
    const glm::dvec3 x = centroid(corners(patch.outline)) + lift * patch.normal;
    return tests <= kMaxTests &&
           std::ranges::any_of(bodies, [&](const ClosedBody& body) { return body.holds(x, tests); });
  });
}

}  // namespace fluxel
