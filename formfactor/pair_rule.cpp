#include "formfactor/pair_rule.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace fluxel {

double pair_form_factor(FormFactor rule, const Element& i, const Element& j) {
  const glm::dvec3 separation = glm::dvec3(j.centroid) - glm::dvec3(i.centroid);
  const double r2 = glm::dot(separation, separation);
  const double cosines =
      std::abs(glm::dot(glm::dvec3(i.normal), separation) * glm::dot(glm::dvec3(j.normal), separation)) / r2;
  const double area_i = static_cast<double>(i.area);
  const double area_j = static_cast<double>(j.area);
  const double bound = rule == FormFactor::disc ? std::max(area_i, area_j) : 0.0;
  return area_j * cosines / (std::numbers::pi * r2 + bound);
}

}  // namespace fluxel
