#include "formfactor/even_points.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace fluxel {

PolygonFan::PolygonFan(const SmallPolygon& corners) : corners_(corners) {
  double sum = 0;
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
    sum += glm::length(glm::cross(corners[k] - corners[0], corners[k + 1] - corners[0]));
    ends_.push_back(sum);
  }
  for (double& end : ends_) end /= sum;
}

glm::dvec3 PolygonFan::point(double u, double v) const {
  std::size_t k = 0;
  while (k + 1 < ends_.size() && u >= ends_[k]) ++k;
  const double start = k > 0 ? ends_[k - 1] : 0;
  const double root = std::sqrt(std::clamp((u - start) / (ends_[k] - start), 0.0, 1.0));
  return corners_[0] + root * (1 - v) * (corners_[k + 1] - corners_[0]) +
         root * v * (corners_[k + 2] - corners_[0]);
}

}  // namespace fluxel
