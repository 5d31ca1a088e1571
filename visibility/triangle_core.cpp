#include "visibility/triangle_core.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "visibility/segment_test.hpp"

namespace fluxel {

TriangleCore::TriangleCore(const Patch& patch, const std::array<glm::dvec3, 3>& corner, double extent)
    : normal(patch.normal), base(patch.outline.corner[0]) {
  // Units in the last place of the extent: within the reach a height over the plane is wrong by less than 30
  // of them, and a crossing by about that over the sine.
  const double rounding = 32 * 0x1p-24 * extent;
  const double inset = outline_margin(patch, extent) + rounding / static_cast<double>(kLeastSine);
  const double doubled_area = glm::length(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k)
    longest = std::max(longest, glm::length(corner[(k + 1) % 3] - corner[k]));
  least_height = static_cast<float>(rounding);
  reach = static_cast<float>(1.01 * extent);
  // The triangle's least height stands on its longest edge.
  least_share = static_cast<float>(std::min(1.0, inset * longest / doubled_area));
}

}  // namespace fluxel
