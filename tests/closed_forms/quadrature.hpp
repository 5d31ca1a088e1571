#pragma once

#include <boost/math/quadrature/gauss.hpp>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>

#include "tests/closed_forms/rectangles.hpp"

namespace fluxel::closed_forms {

inline constexpr glm::dvec3 kOrigin(0), kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

/// Plain product rules for the tests: they know the kernel alone, none of the formulas under test.

template <unsigned kPoints = 20, class Function>
double integrate(double low, double high, Function function) {
  return boost::math::quadrature::gauss<double, kPoints>::integrate(function, low, high);
}

/// Over a rectangle, function(u, v).
template <unsigned kPoints = 20, class Function>
double integrate(const Rectangle& domain, Function function) {
  return integrate<kPoints>(domain.u_low, domain.u_high, [&](double u) {
    return integrate<kPoints>(domain.v_low, domain.v_high, [&](double v) { return function(u, v); });
  });
}

/// cos cos / (pi r^2), 0 where one is behind the other. Unit normals.
inline double kernel(const glm::dvec3& p, const glm::dvec3& p_normal, const glm::dvec3& q,
                     const glm::dvec3& q_normal) {
  const glm::dvec3 way = q - p;
  const double cosines = glm::max(glm::dot(way, p_normal), 0.0) * glm::max(-glm::dot(way, q_normal), 0.0);
  return cosines / (std::numbers::pi * glm::dot(way, way) * glm::dot(way, way));
}

}  // namespace fluxel::closed_forms
