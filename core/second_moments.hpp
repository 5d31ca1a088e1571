#pragma once

#include <glm/vec3.hpp>

#include "core/element.hpp"

namespace fluxel {

/// The covariance of a flat shape's points about its centroid, in its plane: `minor_variance` times the
/// plane's unit tensor, plus `elongation` times itself transposed. A square of side s has minor_variance s^2
/// / 12 and no elongation.
struct SecondMoments {
  double minor_variance = 0;  ///< variance along the shorter principal axis [m2]
  glm::dvec3 elongation{0};   ///< along the longer axis; its square is what that axis has more [m]

  [[nodiscard]] double trace() const;  ///< mean squared distance from the centroid [m2]
};

/// Of a triangle or parallelogram.
[[nodiscard]] SecondMoments second_moments(const Outline<glm::dvec3>& outline);

}  // namespace fluxel
