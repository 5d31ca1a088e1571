#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

#include "formfactor/view_factor.hpp"

namespace fluxel {

/// Points of the unit cube in four dimensions: a Sobol sequence (1967), its digits turned at random by the
/// seed (a digital shift: L'Ecuyer & Lemieux 2002), so that sequences of different seeds err independently.
/// Starts again after kLength points.
class SobolPoints {
 public:
  static constexpr std::size_t kLength = 65536, kAxes = 4;

  explicit SobolPoints(std::uint64_t seed);

  std::array<double, kAxes> next();

 private:
  std::array<std::uint32_t, kAxes> shift_;
  std::size_t place_ = 0;
};

/// A convex polygon as a fan of triangles, to draw its points evenly.
class PolygonFan {
 public:
  /// The polygon must outlive this.
  explicit PolygonFan(const SmallPolygon& corners);

  /// Area-preserving from the unit square, u below 1.
  [[nodiscard]] glm::dvec3 point(double u, double v) const;

 private:
  const SmallPolygon& corners_;
  boost::container::small_vector<double, 8> ends_;  // of each triangle's share of the area
};

}  // namespace fluxel
