#include "formfactor/visible_fraction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "formfactor/even_points.hpp"

namespace fluxel {

namespace {

/// The polygon drawn in towards its centroid until it is `margin` from its edges, by a half at most: what
/// lies nearer to an edge is for rays, in single precision, already part of the wall that may stand there.
SmallPolygon inset(const SampledPolygon& polygon, double margin) {
  const PolygonView outline = corners(polygon.corners);
  const glm::dvec3 centre = centroid(outline);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t edge = 0; edge < outline.size(); ++edge) {
    const Plane plane = edge_plane(outline, edge, polygon.normal);
    if (plane.normal != glm::dvec3(0)) least = std::min(least, plane.distance(centre));
  }
  const double scale = std::max(0.5, 1 - margin / least);
  SmallPolygon drawn_in;
  for (const glm::dvec3& x : outline) drawn_in.push_back(centre + scale * (x - centre));
  return drawn_in;
}

/// Rays between two polygons by one sequence of points, and what they have seen so far.
class RaySequence {
 public:
  RaySequence(const RayScene& ray_scene, const SampledPolygon& P, const SampledPolygon& Q, std::uint64_t seed)
      : ray_scene_(ray_scene), P_(P), Q_(Q), from_(P.corners), to_(Q.corners), places_(seed) {}

  void trace_packet() {
    std::array<SurfaceSegment, RayPacket::kSize> segments;
    std::array<double, RayPacket::kSize> weight;
    for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
      const auto [u, v, s, t] = places_.next();
      segments[k] = {from_.point(u, v), P_.normal, to_.point(s, t), Q_.normal};
      const glm::dvec3 d = segments[k].to - segments[k].from;
      const double r2 = glm::dot(d, d);
      weight[k] = r2 > 0 ? std::abs(glm::dot(P_.normal, d) * glm::dot(Q_.normal, d)) / (r2 * r2) : 0.0;
    }
    const std::uint32_t free = free_segments(ray_scene_, segments);
    for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
      all_ += weight[k];
      if ((free >> k & 1u) != 0) seen_ += weight[k];
    }
    rays_ += RayPacket::kSize;
  }

  [[nodiscard]] std::uint32_t rays() const { return rays_; }
  [[nodiscard]] bool agree() const { return seen_ == 0 || seen_ == all_; }
  [[nodiscard]] double visible() const { return all_ > 0 ? seen_ / all_ : 0.0; }

 private:
  const RayScene& ray_scene_;
  const SampledPolygon &P_, &Q_;
  PolygonFan from_, to_;
  EvenSequence<4> places_;
  double all_ = 0, seen_ = 0;
  std::uint32_t rays_ = 0;
};

}  // namespace

VisibleFraction visible_fraction(const RayScene& ray_scene, const SampledPolygon& P, const SampledPolygon& Q,
                                 std::uint64_t seed, const RayBudget& budget) {
  RaySequence sequence(ray_scene, P, Q, seed);
  sequence.trace_packet();
  if (!sequence.agree()) {
    const double wanted = std::pow(0.5 * budget.share / budget.tolerance, 4.0 / 3.0);
    const auto most = static_cast<std::uint32_t>(std::clamp<double>(wanted, kFewestPairRays, kMostPairRays));
    while (sequence.rays() < most) sequence.trace_packet();
  }
  return {sequence.visible(), sequence.rays()};
}

}  // namespace fluxel
