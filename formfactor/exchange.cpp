#include "formfactor/exchange.hpp"

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "formfactor/shadowed_exchange.hpp"

namespace fluxel {

namespace {

constexpr int kMaxSplits = 24;

struct Extent {
  glm::dvec3 centre{0};
  double radius = 0;  ///< of a sphere around the corners [m]
};

Extent extent_of(const SmallPolygon& polygon) {
  Extent extent;
  for (const glm::dvec3& corner : polygon) extent.centre += corner / static_cast<double>(polygon.size());
  for (const glm::dvec3& corner : polygon)
    extent.radius = std::max(extent.radius, glm::length(corner - extent.centre));
  return extent;
}

/// Both halves across the longest edge or diagonal.
std::pair<SampledPolygon, SampledPolygon> halves(const SampledPolygon& polygon) {
  glm::dvec3 longest(0), middle(0);
  for (std::size_t a = 0; a < polygon.corners.size(); ++a)
    for (std::size_t b = a + 1; b < polygon.corners.size(); ++b)
      if (const glm::dvec3 d = polygon.corners[b] - polygon.corners[a];
          glm::dot(d, d) > glm::dot(longest, longest)) {
        longest = d;
        middle = 0.5 * (polygon.corners[a] + polygon.corners[b]);
      }
  constexpr double kSame = 1e-12;  // a corner so near to the cut, over the length, lies in it: no needles
  const double length = glm::length(longest);
  const glm::dvec3 along = longest / length;
  return {{clip_to_front(corners(polygon.corners), {middle, along}, kSame * length), polygon.normal},
          {clip_to_front(corners(polygon.corners), {middle, -along}, kSame * length), polygon.normal}};
}

/// True where the square on the longest edge or diagonal has more than eight times the polygon's area.
bool is_sliver(const SmallPolygon& polygon) {
  constexpr double kSliver = 8;
  double longest = 0;
  for (const glm::dvec3& a : polygon)
    for (const glm::dvec3& b : polygon) longest = std::max(longest, glm::dot(a - b, a - b));
  return longest > kSliver * area(corners(polygon));
}

/// A pair so far apart that the kernel varies little over it.
bool is_far(const Extent& a, const Extent& b) {
  return 2 * (a.radius + b.radius) < glm::length(a.centre - b.centre);
}

/// At most about this is the error of a contour integral over the smaller area: see ContourPoints.
double contour_error(const SampledPolygon& P, const SampledPolygon& Q, ContourPoints points) {
  constexpr double kFar = 1e-11, kFine = 6e-8, kFineSliver = 5e-7, kCoarse = 9e-5, kCoarseSliver = 1.5e-3;
  if (is_far(extent_of(P.corners), extent_of(Q.corners))) return kFar;
  const bool sliver = is_sliver(P.corners) || is_sliver(Q.corners);
  if (points == ContourPoints::fine) return sliver ? kFineSliver : kFine;
  return sliver ? kCoarseSliver : kCoarse;
}

Exchange sampled(const OcclusionScene& occlusion, const SampledPolygon& P, const SampledPolygon& Q,
                 const Exchange& free, double tolerance, std::uint64_t seed) {
  const FractionEstimate visible = estimate_fraction(occlusion.ray_scene, P, Q, seed, tolerance / free.G);
  Exchange result = free;
  result.G *= visible.value;
  result.error *= visible.value;
  result.variance = free.G * visible.error * free.G * visible.error;
  result.rays = visible.rays;
  return result;
}

/// Nothing where too many stand between.
std::optional<Exchange> past_shadows(const OcclusionScene& occlusion, const SampledPolygon& P,
                                     const SampledPolygon& Q, std::span<const PatchId> between,
                                     const Exchange& free, double tolerance) {
  if (between.size() > kMaxShadows) return std::nullopt;
  boost::container::static_vector<PolygonView, kMaxShadows> outlines;
  for (const PatchId id : between) outlines.push_back(corners(occlusion.occluders.patch(id).outline));
  const auto lift = static_cast<double>(occlusion.ray_scene.surface_epsilon());
  const std::optional<ShadowedArea> seen =
      shadowed_exchange(P, Q, {outlines.data(), outlines.size()}, lift, tolerance);
  if (!seen) return std::nullopt;
  // From lifted points there is a seam of light beside the edges of bodies; whether it is one is not known.
  constexpr double kSeam = 1e-4;
  if (seen->G <= kSeam * free.G) return Exchange{.error = seen->G};
  return Exchange{seen->G, free.error * seen->G / free.G, seen->error * seen->error, 0};
}

Exchange exchange_of(const OcclusionScene& occlusion, const ObstructedPair& pair,
                     const ExchangeTolerance& tolerance, const std::optional<Exchange>& known, int splits) {
  const auto& [P, Q, candidates, seed] = pair;
  if (P.corners.size() < 3 || Q.corners.size() < 3) return {};
  if (candidates.empty()) return known ? *known : free_exchange(P, Q, tolerance.quadrature);
  const Shaft shaft(corners(P.corners), corners(Q.corners));
  std::vector<PatchId> between;
  occlusion.tree.filter(shaft, occlusion.epsilon, candidates, between);
  const bool blocked = std::ranges::any_of(between, [&](PatchId id) {
    return shaft.blocks(occlusion.occluders.patch(id).outline, occlusion.epsilon);
  });
  if (blocked) return {};
  const Exchange free = known ? *known : free_exchange(P, Q, tolerance.quadrature);
  if (between.empty()) return free;
  // What is smaller than the tolerance need not be known better than its half.
  if (free.G <= tolerance.visibility) return {free.G / 2, free.G / 2, 0, 0};

  const Extent extent_P = extent_of(P.corners), extent_Q = extent_of(Q.corners);
  const bool can_split =
      splits < kMaxSplits && P.corners.size() < Shaft::kMaxCorners && Q.corners.size() < Shaft::kMaxCorners;
  if (is_far(extent_P, extent_Q) || !can_split) {
    if (std::optional<Exchange> found = past_shadows(occlusion, P, Q, between, free, tolerance.visibility)) {
      // Rules of few and of more points may miss the same shadow: the error is not taken for less than was
      // asked for.
      found->variance = std::max(found->variance, tolerance.visibility * tolerance.visibility);
      return *found;
    }
    return sampled(occlusion, P, Q, free, tolerance.visibility, seed);
  }

  const bool split_P = extent_P.radius >= extent_Q.radius;
  const auto [first, second] = halves(split_P ? P : Q);
  // Errors of either sign add up in their squares.
  const ExchangeTolerance part{tolerance.quadrature / 2, tolerance.visibility * std::sqrt(0.5)};
  Exchange sum;
  for (std::uint64_t number = 0; number < 2; ++number) {
    const SampledPolygon& half = number == 0 ? first : second;
    const ObstructedPair halved{split_P ? half : P, split_P ? Q : half, between, 2 * seed + number};
    sum += exchange_of(occlusion, halved, part, {}, splits + 1);
  }
  return sum;
}

}  // namespace

Exchange& Exchange::operator+=(const Exchange& other) {
  G += other.G;
  error += other.error;
  variance += other.variance;
  rays += other.rays;
  return *this;
}

double Exchange::total_error() const { return error + std::sqrt(variance); }

Exchange free_exchange(const SampledPolygon& P, const SampledPolygon& Q, double tolerance) {
  const double least = std::min(area(corners(P.corners)), area(corners(Q.corners)));
  const bool coarse = contour_error(P, Q, ContourPoints::coarse) * least <= tolerance;
  const ContourPoints points = coarse ? ContourPoints::coarse : ContourPoints::fine;
  return {exchange_area_by_contour(corners(P.corners), corners(Q.corners), points),
          contour_error(P, Q, points) * least, 0, 0};
}

Exchange exchange_past(const OcclusionScene& occlusion, const ObstructedPair& pair,
                       const ExchangeTolerance& tolerance, const std::optional<Exchange>& free) {
  return exchange_of(occlusion, pair, tolerance, free, 0);
}

std::optional<Exchange> exchange_past_few(const OcclusionScene& occlusion, const ObstructedPair& pair,
                                          const Exchange& free, double tolerance, std::size_t most) {
  if (pair.candidates.empty()) return free;
  // The integral's own rules are too coarse for what is near.
  if (!is_far(extent_of(pair.P.corners), extent_of(pair.Q.corners))) return std::nullopt;
  const Shaft shaft(corners(pair.P.corners), corners(pair.Q.corners));
  std::vector<PatchId> between;
  if (!occlusion.tree.filter(shaft, occlusion.epsilon, pair.candidates, between, most)) return std::nullopt;
  if (between.empty()) return free;
  std::optional<Exchange> found = past_shadows(occlusion, pair.P, pair.Q, between, free, tolerance);
  if (found && found->total_error() > tolerance + free.error) return std::nullopt;
  return found;
}

}  // namespace fluxel
