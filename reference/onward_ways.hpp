#pragma once

#include <algorithm>
#include <glm/vec3.hpp>

#include "optics/scattering.hpp"
#include "reference/lit_point.hpp"

namespace fluxel {

[[nodiscard]] inline double largest_colour(const Rgb& weight) {
  return std::max({weight.r, weight.g, weight.b});
}

/// A side that a path has met.
struct MetPoint {
  LitPoint at;
  bool front = true;
  glm::dvec3 direction{0};  ///< unit, in which the path has come
};

/// Where a path goes on from there.
struct Onward {
  LitPoint at;               ///< and on which side
  bool is_straight = false;  ///< in `direction` alone; else light from all directions counts there
  glm::dvec3 direction{0};   ///< unit
  Rgb weight{0};             ///< of the path from then on
  double compression = 1;    ///< which the weight has more than what is kept of the power
};

/// The ways in which a path that goes backwards may go on from a side, and what is left of its weight by
/// each. Along rays that cross the surface of a clear body radiance over n^2 is what stays, n being the index
/// of refraction (Veach 1997, section 5.2): what comes from behind the surface counts by the square of the
/// index before it over that behind it.
class OnwardWays {
 public:
  /// `side`: see leaving_side; `weight`: of the path that has met it. Both must outlive this.
  OnwardWays(const SideLight& side, const MetPoint& met, const Rgb& weight);

  /// Sum of the largest channels of the weights by each way, without compression.
  [[nodiscard]] double all() const { return all_; }

  /// A way by a number of [0, 1), where `all` is above 0: each as often as its largest channel says, which
  /// its weight is divided by.
  [[nodiscard]] Onward chosen(double number) const;

 private:
  [[nodiscard]] Onward by(const WayShare& way, double chance) const;

  const SideLight& side_;
  MetPoint met_;
  const Rgb& weight_;
  glm::dvec3 normal_;  // the patch's
  Ways ways_;
  double all_ = 0;
};

}  // namespace fluxel
