#pragma once

#include <glm/vec3.hpp>

#include "core/element.hpp"

namespace fluxel {

/// A face as it is seen from a point: points of it are drawn so that every direction is as likely as every
/// other.
class SeenFace {
 public:
  SeenFace(const Outline<glm::dvec3>& outline, const glm::dvec3& from);

  /// [sr], from either side; 0 in its plane. Of each triangle by Van Oosterom & Strackee (1983).
  [[nodiscard]] double solid_angle() const { return first_.solid_angle + second_.solid_angle; }

  /// By two numbers of [0, 1), where the solid angle is not 0 (Arvo 1995).
  [[nodiscard]] glm::dvec3 draw(double u, double v) const;

 private:
  /// Corners as unit vectors from the point.
  struct Triangle {
    glm::dvec3 a{0}, b{0}, c{0};
    double solid_angle = 0;

    Triangle() = default;
    Triangle(const glm::dvec3& first, const glm::dvec3& second, const glm::dvec3& third);
    [[nodiscard]] glm::dvec3 draw(double u, double v) const;
  };

  glm::dvec3 from_, corner_, normal_;
  Triangle first_, second_;  // of a parallelogram
};

}  // namespace fluxel
