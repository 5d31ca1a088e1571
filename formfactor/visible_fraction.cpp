#include "formfactor/visible_fraction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "formfactor/even_points.hpp"
#include "formfactor/seen_polygon.hpp"

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
      : RaySequence(ray_scene, area(corners(P.corners)) <= area(corners(Q.corners)), P, Q, seed) {}

  RaySequence(const RaySequence&) = delete;
  RaySequence& operator=(const RaySequence&) = delete;

  /// Anew, by points that do not depend on those before.
  void restart(std::uint64_t seed) {
    places_ = SobolPoints(seed);
    all_ = seen_ = 0;
    from_seen_ = to_seen_ = glm::dvec3(0);
    rays_ = 0;
  }

  void trace_packet() {
    std::array<SurfaceSegment, RayPacket::kSize> segments;
    std::array<double, RayPacket::kSize> weight;
    for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
      const auto [u, v, s, t] = places_.next();
      weight[k] = draw(from_.point(u, v), s, t, segments[k]);
    }
    const std::uint32_t free = free_segments(ray_scene_, segments);
    for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
      all_ += weight[k];
      if ((free >> k & 1u) == 0 || weight[k] == 0) continue;
      seen_ += weight[k];
      from_seen_ += weight[k] * segments[k].from;
      to_seen_ += weight[k] * segments[k].to;
    }
    rays_ += RayPacket::kSize;
  }

  [[nodiscard]] std::uint32_t rays() const { return rays_; }
  [[nodiscard]] bool agree() const { return seen_ == 0 || seen_ == all_; }
  [[nodiscard]] double visible() const { return all_ > 0 ? seen_ / all_ : 0.0; }

  [[nodiscard]] VisibleFraction found() const {
    if (!(seen_ > 0)) return {.rays = rays_};
    const glm::dvec3 from = from_seen_ / seen_, to = to_seen_ / seen_;
    VisibleFraction found{.value = visible(), .rays = rays_};
    found.at_P = P_is_smaller_ ? from : to;
    found.at_Q = P_is_smaller_ ? to : from;
    return found;
  }

 private:
  static constexpr double kInset = 4;  // of surface_epsilon

  RaySequence(const RayScene& ray_scene, bool P_is_smaller, const SampledPolygon& P, const SampledPolygon& Q,
              std::uint64_t seed)
      : ray_scene_(ray_scene),
        P_is_smaller_(P_is_smaller),
        small_(drawn_in(P_is_smaller ? P : Q)),
        large_(drawn_in(P_is_smaller ? Q : P)),
        centre_(centroid(corners(large_.corners))),
        from_(small_.corners),
        to_(large_.corners),
        places_(seed) {
    for (const glm::dvec3& corner : large_.corners)
      radius_ = std::max(radius_, glm::distance(corner, centre_));
  }

  [[nodiscard]] SampledPolygon drawn_in(const SampledPolygon& polygon) const {
    return {inset(polygon, kInset * static_cast<double>(ray_scene_.surface_epsilon())), polygon.normal};
  }

  /// A segment from a point of the smaller polygon to the larger, and the exchange that it stands for. Of a
  /// near polygon the few places that are nearest carry most of the exchange. Were all of them drawn alike,
  /// most sequences would miss these and take what the others see for the whole; so places are drawn by their
  /// directions.
  double draw(const glm::dvec3& from, double s, double t, SurfaceSegment& segment) const {
    constexpr double kFar = 1.5;  // radii: further away all places count about alike
    segment = {from, small_.normal, glm::dvec3(0), large_.normal};
    if (glm::distance(from, centre_) < kFar * radius_) {
      const SeenPolygon seen(from, corners(large_.corners), large_.normal);
      segment.to = seen.point(s, t);
      const double r = glm::distance(segment.to, from);
      return r > 0 ? seen.solid_angle() * std::abs(glm::dot(small_.normal, segment.to - from)) / r : 0.0;
    }
    segment.to = to_.point(s, t);
    const glm::dvec3 d = segment.to - from;
    const double r2 = glm::dot(d, d);
    return r2 > 0 ? area_ * std::abs(glm::dot(small_.normal, d) * glm::dot(large_.normal, d)) / (r2 * r2)
                  : 0.0;
  }

  const RayScene& ray_scene_;
  bool P_is_smaller_;
  const SampledPolygon small_, large_;
  glm::dvec3 centre_;  // of the larger
  double radius_ = 0;  // around it [m]
  double area_ = area(corners(large_.corners));
  PolygonFan from_, to_;
  SobolPoints places_;
  double all_ = 0, seen_ = 0;
  glm::dvec3 from_seen_{0}, to_seen_{0};  // sums of places, of the smaller and of the larger
  std::uint32_t rays_ = 0;
};

}  // namespace

double rays_at_an_edge(const RayBudget& budget) {
  return std::pow(0.5 * budget.share / budget.tolerance, 1.5);
}

double error_at_an_edge(double rays) { return 0.5 * std::pow(rays, -2.0 / 3); }

VisibleFraction visible_fraction(const RayScene& ray_scene, const SampledPolygon& P, const SampledPolygon& Q,
                                 std::uint64_t seed, const RayBudget& budget) {
  RaySequence sequence(ray_scene, P, Q, seed);
  // Rays that agree may all have missed what another would have met: of n rays half a ray's share.
  const auto rays_for = [](double wanted) {
    return static_cast<std::uint32_t>(std::clamp<double>(wanted, kMinPairRays, kMaxPairRays));
  };
  const std::uint32_t if_they_agree = rays_for(0.5 * budget.share / budget.unanimous_tolerance);
  const std::uint32_t if_not = rays_for(rays_at_an_edge(budget));
  std::uint32_t wanted = std::max(if_they_agree, if_not), pilots = 0;
  bool pilots_agree = false;
  if (if_they_agree < if_not) {
    sequence.trace_packet();
    pilots = sequence.rays();
    pilots_agree = sequence.agree();
    if (pilots_agree) wanted = if_they_agree;
    sequence.restart(~seed);
  }
  while (sequence.rays() < wanted) sequence.trace_packet();
  VisibleFraction found = sequence.found();
  found.pilots = pilots;
  found.agree = pilots > 0 ? pilots_agree : sequence.agree();
  return found;
}

FractionEstimate estimate_fraction(const RayScene& ray_scene, const SampledPolygon& P,
                                   const SampledPolygon& Q, std::uint64_t seed, double wanted) {
  constexpr std::size_t kSequences = 8;
  constexpr auto kCount = static_cast<double>(kSequences);
  // Of eight values the standard deviation is uncertain by a quarter, and stopping favours what looks small.
  constexpr double kStoppingCaution = 1.25;
  std::deque<RaySequence> sequences;
  for (std::size_t k = 0; k < kSequences; ++k) sequences.emplace_back(ray_scene, P, Q, kSequences * seed + k);
  // One packet often is enough to see that all is dark or free.
  sequences[0].trace_packet();
  FractionEstimate result{sequences[0].visible(), 0.5 / RayPacket::kSize, RayPacket::kSize};
  if (sequences[0].agree() && result.error <= wanted) return result;

  for (std::uint32_t length = RayPacket::kSize; result.rays < kMaxEstimateRays; length *= 2) {
    double sum = 0, squares = 0;
    bool agree = true;
    for (RaySequence& sequence : sequences) {
      while (sequence.rays() < length) sequence.trace_packet();
      const double visible = sequence.visible();
      sum += visible;
      squares += visible * visible;
      agree = agree && sequence.agree();
    }
    result.rays = kSequences * length;
    result.value = sum / kCount;
    agree = agree && (sum == 0 || sum == kCount);
    const double variance = std::max(0.0, squares / kCount - result.value * result.value) / (kCount - 1);
    result.error = agree ? 0.5 / static_cast<double>(result.rays) : kStoppingCaution * std::sqrt(variance);
    if (result.error <= wanted) break;
  }
  return result;
}

}  // namespace fluxel
