#include "bench/gpu_check/distances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "visibility/cuda/trace_group.hpp"

namespace fluxel::cuda::checks {

namespace {

struct Segment {
  Double3 from, along;
};

Double3 at(const Segment& segment, double share) { return segment.from + share * segment.along; }

/// The share of the segment's length at which it is nearest to a point.
double nearest_share(const Segment& segment, const Double3& point) {
  const double squared = dot(segment.along, segment.along);
  return squared > 0 ? std::clamp(dot(point - segment.from, segment.along) / squared, 0.0, 1.0) : 0;
}

double distance(const Segment& segment, const Double3& point) {
  return length(at(segment, nearest_share(segment, point)) - point);
}

/// Ericson, Real-time collision detection, 2005, 5.1.9.
double distance(const Segment& a, const Segment& b) {
  const Double3 between = a.from - b.from;
  const double aa = dot(a.along, a.along), bb = dot(b.along, b.along), ab = dot(a.along, b.along);
  const double determinant = aa * bb - ab * ab;
  const double share =
      determinant > 0 ? (ab * dot(b.along, between) - bb * dot(a.along, between)) / determinant : 0;
  const double on_b = nearest_share(b, at(a, std::clamp(share, 0.0, 1.0)));
  const Double3 point = at(b, on_b);
  return length(at(a, nearest_share(a, point)) - point);
}

double distance(const ExactPatch& patch, const Double3& point) {
  bool inside = true;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t c = 0; c < patch.corners; ++c) {
    const Double3 from = patch.corner[c], along = patch.corner[(c + 1) % patch.corners] - from;
    inside = inside && dot(cross(patch.normal, along), point - from) >= 0;
    least = std::min(least, distance(Segment{from, along}, point));
  }
  return inside ? std::fabs(dot(patch.normal, point - patch.corner[0])) : least;
}

}  // namespace

NearMiss near_miss(const TileScene& scene, const End& row, const End& column) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  NearMiss least{kFar, kFar};
  for (std::uint32_t sides = 0; sides < 4; ++sides) {
    if (!face_each_other(row, column, {sides / 2, sides % 2}, 2 * scene.lift)) continue;
    const Float3 from = lifted(row, sides / 2, scene.lift);
    const Segment ray{widen(from), widen(lifted(column, sides % 2, scene.lift) - from)};
    for (std::uint32_t number = 0; number < scene.patches; ++number) {
      const ExactPatch& patch = scene.exact[number];
      for (std::uint32_t c = 0; c < patch.corners; ++c) {
        const Double3 corner = patch.corner[c];
        const Segment edge{corner, patch.corner[(c + 1) % patch.corners] - corner};
        least.edge = std::min(least.edge, distance(ray, edge));
      }
      least.end = std::min({least.end, distance(patch, ray.from), distance(patch, at(ray, 1))});
    }
  }
  return least;
}

}  // namespace fluxel::cuda::checks
