#include "scene/convexity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <vector>

#include "scene/contact_pairs.hpp"
#include "scene/polygon.hpp"

namespace fluxel {
namespace {

/// Distances that are looked at before giving up: a fraction of a second.
constexpr std::size_t kMaxDistances = 200'000'000;

/// Planes that agree to this, in normal and in distance over the extent, are tried once.
constexpr double kSamePlane = 1e-9;

std::vector<Plane> distinct_planes(const Scene& scene) {
  std::vector<std::pair<std::array<std::int64_t, 4>, std::size_t>> keys;
  for (std::size_t i = 0; i < scene.patches.size(); ++i) {
    const Patch& patch = scene.patches[i];
    const glm::dvec3 n = patch.normal / kSamePlane;
    const double distance = glm::dot(patch.normal, patch.outline.corner[0]) / (kSamePlane * scene.extent);
    keys.push_back({{std::llround(n.x), std::llround(n.y), std::llround(n.z), std::llround(distance)}, i});
  }
  std::ranges::sort(keys);
  keys.erase(
      std::unique(keys.begin(), keys.end(), [](const auto& a, const auto& b) { return a.first == b.first; }),
      keys.end());
  // In the order of the patches, so that a scene's answer does not hang on how its planes are rounded.
  std::ranges::sort(keys, {}, [](const auto& entry) { return entry.second; });
  std::vector<Plane> planes;
  planes.reserve(keys.size());
  for (const auto& [key, i] : keys)
    planes.push_back({scene.patches[i].outline.corner[0], scene.patches[i].normal});
  return planes;
}

}  // namespace

bool is_convex(const Scene& scene) {
  const double tolerance = contact_tolerance(scene);
  std::size_t distances = 0;
  for (const Plane& plane : distinct_planes(scene)) {
    bool in_front = false, behind = false;
    for (const Patch& patch : scene.patches) {
      for (const glm::dvec3& x : corners(patch.outline)) {
        const double distance = plane.distance(x);
        in_front = in_front || distance > tolerance;
        behind = behind || distance < -tolerance;
      }
      distances += patch.outline.corners;
      if ((in_front && behind) || distances > kMaxDistances) return false;
    }
  }
  return true;
}

}  // namespace fluxel
