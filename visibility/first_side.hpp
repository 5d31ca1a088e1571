#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "visibility/ray_scene.hpp"

namespace fluxel {

/// A side of a patch that a ray ends on.
struct MetSide {
  PatchId patch = kNoPatch;  ///< none: the ray leaves the scene
  bool front = true;
  bool active = false;  ///< whether the side sends and receives
  double t = 0;         ///< of the ray
};

/// Which side a ray ends on. Where patches coincide, which of them a ray meets first is chance; as in the
/// raster of the camera an active side then goes before one that is dark, an emitter before what it lies on,
/// then the lower patch. Queries may run from many threads at once.
class FirstSide {
 public:
  /// Must outlive this.
  explicit FirstSide(const RayScene& ray_scene);

  /// The origin is lifted off its own surface.
  [[nodiscard]] MetSide meet(const glm::dvec3& origin, const glm::dvec3& direction) const;
  /// The same of many rays, as RayScene::first_hits has it.
  void meet(std::span<const Ray> rays, std::span<MetSide> met) const;

  /// Of a ray that is known to meet that first.
  [[nodiscard]] MetSide meet(const Ray& ray, const PatchHit& hit) const;

  /// Whether others have taken area from the patch.
  [[nodiscard]] bool is_covered(PatchId patch) const { return covered_[index(patch)]; }

 private:
  [[nodiscard]] MetSide side_of(const PatchHit& hit, const glm::dvec3& direction) const;

  const RayScene& ray_scene_;
  std::vector<bool> covered_;  // patches that others have taken area from
};

}  // namespace fluxel
