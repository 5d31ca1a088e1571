#include "hierarchy/seen_slope.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "hierarchy/block.hpp"

namespace fluxel {

glm::dvec2 seen_slope(const NodeTree& tree, NodeId face, const glm::dvec3& at) {
  const Node& node = tree[face];
  const PlaneAxes& axes = tree.axes(face);
  const auto in_plane = [&axes](const glm::dvec3& d) {
    return glm::dvec2(glm::dot(d, axes.u), glm::dot(d, axes.v));
  };
  // Over the face places x from the centroid have the covariance k I + e e^T; the function 1 + s x has the
  // mean place (k I + e e^T) s.
  const glm::dvec2 mean = in_plane(at - node.shape.centroid), e = in_plane(node.shape.moments.elongation);
  const double k = node.shape.moments.spread;
  if (!(k > 0)) return glm::dvec2(0);
  const glm::dvec2 slope = node.radius / k * (mean - glm::dot(e, mean) / (k + glm::dot(e, e)) * e);
  double lowest = -1, steepest = std::max({kSteepest, std::abs(slope.x), std::abs(slope.y)});
  const Outline<glm::dvec3>& outline = tree.outline(face);
  for (std::uint32_t c = 0; c < outline.corners; ++c)
    lowest =
        std::min(lowest, glm::dot(slope, in_plane(outline.corner[c] - node.shape.centroid)) / node.radius);
  return std::min(-1 / lowest, kSteepest / steepest) * slope;
}

}  // namespace fluxel
