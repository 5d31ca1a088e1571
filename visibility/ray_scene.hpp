#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/ids.hpp"
#include "scene/scene.hpp"
#include "visibility/untraceable_ray.hpp"

namespace fluxel {

/// Sixteen segments, one component an array, from the origin to origin + direction.
struct alignas(64) RayPacket {
  static constexpr int kSize = 16;
  std::array<float, kSize> origin_x, origin_y, origin_z, direction_x, direction_y, direction_z;

  void set_segment(int k, const glm::vec3& from, const glm::vec3& to) {
    const auto lane = static_cast<std::size_t>(k);
    origin_x[lane] = from.x, origin_y[lane] = from.y, origin_z[lane] = from.z;
    direction_x[lane] = to.x - from.x, direction_y[lane] = to.y - from.y, direction_z[lane] = to.z - from.z;
  }
};

/// A ray in double precision; the direction need not be normalised.
struct Ray {
  glm::dvec3 origin{0}, direction{0};
};

/// A hit of a ray with a patch; t is computed in double precision from the patch's plane.
struct PatchHit {
  PatchId patch = kNoPatch;
  double t = 0;
};

/// The patches as occluders: the only place that knows Embree. Queries may run from many threads at once.
/// Patches are hit from both sides. Queries throw UntraceableRay.
class RayScene {
 public:
  /// Of all patches of the scene, or of those listed. The scene must outlive this.
  /// Throws std::runtime_error with Embree's reason.
  RayScene(const Scene& scene, int threads);
  RayScene(const Scene& scene, std::span<const PatchId> patches, int threads);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  /// The nearest hit in front of the origin, or kNoPatch. `direction` need not be normalised; the origin may
  /// be as far away as double precision allows.
  [[nodiscard]] PatchHit first_hit(const glm::dvec3& origin, const glm::dvec3& direction) const;

  /// The same of each of many rays, in packets. Where two patches are met within single precision of each
  /// other, which of them comes first may depend on what is in a packet.
  void first_hits(std::span<const Ray> rays, std::span<PatchHit> hits) const;

  /// Adds every hit with t up to t_max to `hits`, in no order; a patch may come twice (on its diagonal).
  void all_hits(const glm::dvec3& origin, const glm::dvec3& direction, double t_max,
                std::vector<PatchHit>& hits) const;

  /// Bit k is set where segment k of `count` meets a patch, as visibility/segment_test has it.
  [[nodiscard]] std::uint32_t occluded(const RayPacket& rays, int count) const;

  [[nodiscard]] const Scene& scene() const;

  /// Distance [m] from a patch's plane within which a hit means the patch itself: the scene's
  /// contact_tolerance plus four units in the last place of its largest coordinate in single precision.
  [[nodiscard]] float surface_epsilon() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What RayScene::surface_epsilon of all patches of the scene is [m].
[[nodiscard]] float surface_epsilon(const Scene& scene);

/// Surfaces that far apart [m] rays tell apart wherever they lie: two surface epsilons, below which an
/// element lies in the other's plane (kFacingHeights), and the rounding of their places in single precision.
[[nodiscard]] double least_gap(const Scene& scene);

/// In surface epsilons: how high over each other's planes two elements have to lie to see each other.
inline constexpr float kFacingHeights = 2;

/// As "Embree 3.13.5".
[[nodiscard]] std::string ray_engine_version();

}  // namespace fluxel
