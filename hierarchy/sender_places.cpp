#include "hierarchy/sender_places.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/sampling.hpp"

namespace fluxel {

SenderPlaces::SenderPlaces(const NodeTree& tree, NodeId face, const glm::dvec3& point,
                           const glm::dvec3& normal)
    : outline_(tree.outline(face)), shape_(tree[face].shape), point_(point), normal_(normal) {
  constexpr double kFarFromPoint =
      0.04;  // mean square of the distances from the centroid, over the squared distance
  const glm::dvec3 d = shape_.centroid - point;
  if (shape_.moments.trace() > kFarFromPoint * glm::dot(d, d))
    seen_.emplace(point, corners(outline_), shape_.normal);
}

SenderPlace SenderPlaces::at(double u, double v) const {
  SenderPlace place{
      {point_, normal_, seen_ ? seen_->point(u, v) : surface_point(outline_, u, v), shape_.normal}};
  const glm::dvec3 d = place.segment.to - point_;
  const double r2 = glm::dot(d, d), r = std::sqrt(r2);
  if (!(r > 0)) return place;
  const double solid_angle =
      seen_ ? seen_->solid_angle() : shape_.area * -glm::dot(shape_.normal, d) / (r2 * r);
  place.F = solid_angle * std::max(0.0, glm::dot(normal_, d)) / (std::numbers::pi * r);
  return place;
}

}  // namespace fluxel
