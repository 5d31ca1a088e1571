#pragma once

#include "visibility/cuda/ray.hpp"
#include "visibility/cuda/tree_walk.hpp"

namespace fluxel::cuda {

inline constexpr std::uint32_t kNoHit = 0xFFFFFFFFu;

/// What a ray meets first. t, from the patch's plane in double precision, is the ray's parameter; 0 where
/// nothing is met.
struct NearestHit {
  double t;
  std::uint32_t patch;  ///< its place in the scene; kNoHit: none
};

/// Of the scene's extent, by how much the box of a patch is widened in which rays meet it: more than rounding
/// moves them, and less than the boxes of the tree are widened.
inline constexpr double kMeetingMargin = 8 * static_cast<double>(kUlp);

FLUXEL_PORTABLE inline double coordinate(const Double3& v, int axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/// Where a ray that meets the patch does so, by its parameter: at the plane, but on the ray's way through the
/// patch's box widened by `margin` [m], as the rounding of a ray that grazes the plane could move it
/// anywhere, and in particular out of the boxes of the tree.
FLUXEL_PORTABLE inline double met_at(const ExactPatch& patch, const Double3& from, const Double3& along,
                                     double margin) {
  double near = -INFINITY, far = INFINITY;
  for (int axis = 0; axis < 3; ++axis) {
    double low = INFINITY, high = -INFINITY;
    for (std::uint32_t c = 0; c < patch.corners; ++c) {
      low = lesser(low, coordinate(patch.corner[c], axis));
      high = greater(high, coordinate(patch.corner[c], axis));
    }
    const double origin = coordinate(from, axis), direction = coordinate(along, axis);
    const double a = (low - margin - origin) / direction, b = (high + margin - origin) / direction;
    near = std::fmax(near, std::fmin(a, b));
    far = std::fmin(far, std::fmax(a, b));
  }
  return std::fmax(near, std::fmin(far, plane_parameter(polygon_of(patch), from, along)));
}

/// The nearest of the patches that a ray has been found to meet, those met at the same place by their number.
class NearestPatch {
 public:
  /// A ray as it is traced, from where it is near the scene on, with the coordinates of single precision in
  /// which Embree would take it: so both decide on the same ray. `margin`: that of met_at.
  FLUXEL_PORTABLE NearestPatch(const Double3& from, const Double3& along, double margin)
      : from_(from), along_(along), margin_(margin) {}

  /// The patch at a place in the scene, if the ray meets it.
  FLUXEL_PORTABLE void look_at(const ExactPatch& patch, std::uint32_t place) {
    if (!ray_meets(polygon_of(patch), from_, along_)) return;
    const double at = std::fmax(0.0, met_at(patch, from_, along_, margin_));
    if (at > at_ || (at == at_ && patch.number > number_)) return;
    at_ = at;
    number_ = patch.number;
    place_ = place;
  }

  /// How far along the traced ray patches are still looked for.
  [[nodiscard]] FLUXEL_PORTABLE double far() const { return at_; }
  [[nodiscard]] FLUXEL_PORTABLE std::uint32_t place() const { return place_; }

 private:
  Double3 from_, along_;
  double margin_;  // [m]
  double at_ = INFINITY;
  std::uint32_t number_ = kNoHit, place_ = kNoHit;
};

/// Children that the ray may enter before it ends at `far`, each as a digit of base 16 that is one more than
/// its number, the nearest lowest.
template <class Scene>
FLUXEL_PORTABLE std::uint32_t nearest_first(const Scene& scene, const WideNode& node, const Slabs& slabs,
                                            float far) {
  float entries[8];
  std::uint32_t order = 0;
  std::uint32_t count = 0;
  for (std::uint32_t child = 0; child < 8; ++child) {
    if (!is_node(node, child) && patches_of(node, child) == 0) continue;
    scene.count(Work::box_of_ray);
    const float entry = entry_of_box(slabs, child_box(node, child), far);
    if (!(entry < INFINITY)) continue;
    std::uint32_t place = count++;
    for (; place > 0 && entries[place - 1] > entry; --place) entries[place] = entries[place - 1];
    entries[place] = entry;
    const std::uint32_t before = (1u << 4 * place) - 1;
    order = (order & before) | (child + 1) << 4 * place | (order & ~before) << 4;
  }
  return order;
}

/// Has `looker` look at all patches that the traced ray may meet up to looker.far(), which may become less as
/// it looks.
template <class Scene, class Looker>
FLUXEL_PORTABLE void walk_along(const Scene& scene, const Float3& from, const Float3& along, Looker& looker) {
  struct Siblings {
    std::uint32_t node;
    std::uint32_t left;  // children still to be looked at, as nearest_first has them
  };
  Siblings stack[kMaxLevels];
  std::uint32_t size = 0;
  const Slabs slabs(from, along);
  const float ray_length = length(along);
  auto far = static_cast<float>(looker.far());
  stack[size++] = {0, nearest_first(scene, scene.nodes[0], slabs, far)};
  while (size > 0) {
    Siblings& top = stack[size - 1];
    if (top.left == 0) {
      --size;
      continue;
    }
    const std::uint32_t child = (top.left & 15u) - 1;
    top.left >>= 4;
    const WideNode& node = scene.nodes[top.node];
    scene.count(Work::box_of_ray);
    if (!(entry_of_box(slabs, child_box(node, child), far) < INFINITY)) continue;
    if (is_node(node, child)) {
      const std::uint32_t next = child_node(node, child);
      stack[size++] = {next, nearest_first(scene, scene.nodes[next], slabs, far)};
      continue;
    }
    const std::uint32_t first = node.first_patch + (node.patches[child] & 31u);
    for (std::uint32_t patch = first; patch < first + patches_of(node, child); ++patch) {
      const Occluder& occluder = scene.occluders[patch];
      const float farthest = length(occluder.centre - from) + occluder.radius;
      scene.count(Work::patch_of_ray);
      if (passes_by(occluder, from, along, volume_margin(farthest, ray_length, scene.extent))) continue;
      scene.count(Work::exact_patch);
      looker.look_at(scene.exact[patch], patch);
      far = static_cast<float>(looker.far());
    }
  }
}

/// A ray as it is traced: from where it enters the scene, rounded to single precision.
struct TracedRay {
  Float3 from, along;
  double entry;  ///< by the ray's parameter; infinity where it passes the scene by
};

FLUXEL_PORTABLE inline TracedRay traced(const TileScene& scene, const Ray& ray) {
  const double entry = scene.patches == 0 ? INFINITY : entry_of_ray(ray.origin, ray.direction, scene.extent);
  if (entry == INFINITY) return {{0, 0, 0}, {0, 0, 0}, entry};
  return {narrow(ray.origin + entry * ray.direction), narrow(ray.direction), entry};
}

/// The first patch that a ray meets, as RayScene::first_hit has it, but that Embree compares distances in
/// single precision. `look` is given the ray as it is traced and the NearestPatch.
template <class Look>
FLUXEL_PORTABLE NearestHit nearest_hit(const TileScene& scene, const Ray& ray, const Look& look) {
  const TracedRay as_traced = traced(scene, ray);
  if (as_traced.entry == INFINITY) return {0, kNoHit};
  const double margin = kMeetingMargin * static_cast<double>(scene.extent);
  NearestPatch nearest(widen(as_traced.from), widen(as_traced.along), margin);
  look(as_traced, nearest);
  const std::uint32_t place = nearest.place();
  if (place == kNoHit) return {0, kNoHit};
  return {met_at(scene.exact[place], ray.origin, ray.direction, margin), place};
}

template <class Scene>
FLUXEL_PORTABLE NearestHit nearest_hit(const Scene& scene, const Ray& ray) {
  return nearest_hit(scene, ray, [&](const TracedRay& as_traced, NearestPatch& nearest) {
    walk_along(scene, as_traced.from, as_traced.along, nearest);
  });
}

}  // namespace fluxel::cuda
