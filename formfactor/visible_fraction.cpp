#include "formfactor/visible_fraction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace fluxel {

namespace {

/// Powers of 1/g, g the root of g^5 = g + 1: the most even additive recurrence known in four dimensions.
constexpr std::array<double, 4> kSteps{0.8566748838545029, 0.7338918566271260, 0.6287067210378087,
                                       0.5385972572236101};

double fraction(double x) { return x - std::floor(x); }

/// Random bits of a seed (SplitMix64: Steele, Lea & Flood 2014).
std::uint64_t mix(std::uint64_t state) {
  state += 0x9E3779B97F4A7C15ull;
  state = (state ^ (state >> 30)) * 0xBF58476D1CE4E5B9ull;
  state = (state ^ (state >> 27)) * 0x94D049BB133111EBull;
  return state ^ (state >> 31);
}

/// The triangles of a polygon's fan, with the share of the area that lies before each.
class Fan {
 public:
  explicit Fan(const SmallPolygon& corners) : corners_(corners) {
    double sum = 0;
    for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
      sum += glm::length(glm::cross(corners[k] - corners[0], corners[k + 1] - corners[0]));
      ends_.push_back(sum);
    }
    for (double& end : ends_) end /= sum;
  }

  /// Area-preserving from the unit square.
  [[nodiscard]] glm::dvec3 point(double u, double v) const {
    std::size_t k = 0;
    while (k + 1 < ends_.size() && u >= ends_[k]) ++k;
    const double start = k > 0 ? ends_[k - 1] : 0;
    const double root = std::sqrt(std::clamp((u - start) / (ends_[k] - start), 0.0, 1.0));
    return corners_[0] + root * (1 - v) * (corners_[k + 1] - corners_[0]) +
           root * v * (corners_[k + 2] - corners_[0]);
  }

 private:
  const SmallPolygon& corners_;
  boost::container::small_vector<double, 8> ends_;
};

}  // namespace

VisibleFraction visible_fraction(const RayScene& ray_scene, const SampledPolygon& P, const SampledPolygon& Q,
                                 std::uint64_t seed, const RayBudget& budget) {
  const Fan from(P.corners), to(Q.corners);
  std::array<double, 4> place;
  for (std::size_t axis = 0; axis < 4; ++axis)
    place[axis] = static_cast<double>(mix(seed + axis * 0xD1342543DE82EF95ull) >> 11) * 0x1p-53;

  double all = 0, seen = 0;
  VisibleFraction result;
  std::uint32_t most = kFewestPairRays;
  while (result.rays < most) {
    std::array<SurfaceSegment, RayPacket::kSize> segments;
    std::array<double, RayPacket::kSize> weight;
    for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
      segments[k] = {from.point(place[0], place[1]), P.normal, to.point(place[2], place[3]), Q.normal};
      const glm::dvec3 d = segments[k].to - segments[k].from;
      const double r2 = glm::dot(d, d);
      weight[k] = r2 > 0 ? std::abs(glm::dot(P.normal, d) * glm::dot(Q.normal, d)) / (r2 * r2) : 0.0;
      for (std::size_t axis = 0; axis < 4; ++axis) place[axis] = fraction(place[axis] + kSteps[axis]);
    }
    const std::uint32_t free = free_segments(ray_scene, segments);
    for (std::size_t k = 0; k < RayPacket::kSize; ++k) {
      all += weight[k];
      if ((free >> k & 1u) != 0) seen += weight[k];
    }
    result.rays += RayPacket::kSize;
    if (result.rays == kFewestPairRays && seen > 0 && seen < all) {
      const double wanted = std::pow(0.5 * budget.share / budget.tolerance, 4.0 / 3.0);
      most = static_cast<std::uint32_t>(std::clamp<double>(wanted, kFewestPairRays, kMostPairRays));
    }
  }
  result.value = all > 0 ? seen / all : 0.0;
  return result;
}

}  // namespace fluxel
