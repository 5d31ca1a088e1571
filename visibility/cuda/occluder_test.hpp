#pragma once

#include "visibility/cuda/segment.hpp"
#include "visibility/cuda/shaft.hpp"
#include "visibility/cuda/tile_scene.hpp"

namespace fluxel::cuda {

/// By how much an inequality in single precision has to hold to be certain; the bounds are those of
/// visibility/passage-inl.hpp.
struct Margins {
  float height;  ///< [m], over the occluder's plane
  float volume;  ///< [m3], six times that over an edge and a ray
};

/// For the lines of rays of this length that begin no farther than `from` from any of the occluder's corners
/// [m].
FLUXEL_PORTABLE inline float volume_margin(float from, float ray_length, float extent) {
  return kUlp * (16 * from + 4 * extent) * from * ray_length;
}

/// For rays no longer than `longest` that begin no farther than `from`, and end no farther than `to`, from
/// any of the occluder's corners [m].
FLUXEL_PORTABLE inline Margins margins(float from, float to, float longest, float extent) {
  return {6 * kUlp * (greater(from, to) + extent) + 16 * kUlp * extent, volume_margin(from, longest, extent)};
}

/// Six times the least and the largest of the volumes over a ray and each edge [m3].
struct EdgeVolumes {
  float least, most;
};

FLUXEL_PORTABLE inline EdgeVolumes edge_volumes(const Occluder& occluder, const Float3& from,
                                                const Float3& along) {
  EdgeVolumes volumes{INFINITY, -INFINITY};
  Float3 last = occluder.corner[occluder.corners - 1] - from;
  for (std::uint32_t c = 0; c < occluder.corners; ++c) {
    const Float3 next = occluder.corner[c] - from;
    const float volume = dot(cross(next, last), along);
    volumes.least = lesser(volumes.least, volume);
    volumes.most = greater(volumes.most, volume);
    last = next;
  }
  return volumes;
}

/// Whether the ray's line certainly has edges on both of its sides, so that it misses the occluder.
FLUXEL_PORTABLE inline bool passes_by(const Occluder& occluder, const Float3& from, const Float3& along,
                                      float margin) {
  const EdgeVolumes volumes = edge_volumes(occluder, from, along);
  return volumes.least < -margin && volumes.most > margin;
}

enum class Meeting { none, certain, unsure };

/// Whether the segment meets the occluder: where the tetrahedra over it and each edge have volumes of one
/// sign, and its ends lie on different sides of the plane.
FLUXEL_PORTABLE inline Meeting meeting(const Occluder& occluder, const Float3& from, const Float3& along,
                                       const Margins& margin) {
  const Float3 base = from - occluder.corner[0];
  const float from_height = dot(occluder.normal, base);
  const float to_height = dot(occluder.normal, base + along);
  const bool from_above = from_height > margin.height, from_below = from_height < -margin.height;
  const bool to_above = to_height > margin.height, to_below = to_height < -margin.height;
  if ((from_above && to_above) || (from_below && to_below)) return Meeting::none;

  const EdgeVolumes volumes = edge_volumes(occluder, from, along);
  const float least = from_height > 0 ? volumes.least : -volumes.most;
  const float most = from_height > 0 ? volumes.most : -volumes.least;
  const bool side_known = from_above || from_below;
  if (least < -margin.volume && (side_known || most > margin.volume)) return Meeting::none;
  const bool crosses = (from_above && to_below) || (from_below && to_above);
  return crosses && least > margin.volume ? Meeting::certain : Meeting::unsure;
}

FLUXEL_PORTABLE inline Polygon<Double3> polygon_of(const ExactPatch& patch) {
  return {patch.corner, patch.corners, patch.normal};
}

/// What the segment test says of a patch: in single precision where that is certain.
template <class Scene>
FLUXEL_PORTABLE bool meets(const Scene& scene, std::uint32_t patch, const Float3& from, const Float3& along,
                           const Margins& margin) {
  scene.count(Work::patch_of_ray);
  const Meeting rough = meeting(scene.occluders[patch], from, along, margin);
  if (rough != Meeting::unsure) return rough == Meeting::certain;
  scene.count(Work::exact_patch);
  return segment_meets(polygon_of(scene.exact[patch]), widen(from), widen(from) + widen(along));
}

}  // namespace fluxel::cuda
