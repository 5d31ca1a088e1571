#include "hierarchy/seen_slope.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "hierarchy/link.hpp"

namespace fluxel {

double largest_drop(const NodeTree& tree, NodeId face, const glm::dvec2& slope) {
  double lowest = 0;
  const Outline<glm::dvec3>& outline = tree.outline(face);
  for (std::uint32_t c = 0; c < outline.corners; ++c)
    lowest = std::min(lowest, glm::dot(slope, tree.place(face, outline.corner[c])));
  return -lowest;
}

double steepness(const NodeTree& tree, NodeId face, const glm::dvec2& slope) {
  return std::max(largest_drop(tree, face, slope),
                  std::max(std::abs(slope.x), std::abs(slope.y)) / kSteepest);
}

glm::dvec2 seen_slope(const NodeTree& tree, NodeId face, const glm::dvec3& at) {
  // The function 1 + s x has the mean place C s, of places with the covariance C.
  const glm::dmat2 covariance = tree.covariance(face);
  if (!(glm::determinant(covariance) > 0)) return glm::dvec2(0);
  const glm::dvec2 slope = glm::inverse(covariance) * tree.place(face, at);
  return slope / std::max(1.0, steepness(tree, face, slope));
}

}  // namespace fluxel
