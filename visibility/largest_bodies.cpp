#include "visibility/largest_bodies.hpp"

#include <algorithm>
#include <functional>
#include <glm/geometric.hpp>

namespace fluxel {

namespace {

/// Between the corners that face each other in a rectangle or in a box.
glm::vec3 centre(std::span<const glm::vec3> hull) {
  return 0.5f * (hull[0] + hull[hull.size() == 4 ? 2 : 7]);
}

}  // namespace

float mean_radius(const RayBundle& bundle) {
  const auto radius = [](std::span<const glm::vec3> hull) { return glm::length(hull[0] - centre(hull)); };
  return 0.5f *
         (radius(bundle.from.corners(bundle.row_side)) + radius(bundle.to.corners(bundle.column_side)));
}

std::size_t largest_first(const RayBundle& bundle, std::span<const ConvexBody> bodies, std::size_t most,
                          float least_breadth, std::vector<std::uint32_t>& numbers) {
  const auto narrow = std::partition(numbers.begin(), numbers.end(), [&](std::uint32_t number) {
    return bodies[number].breadth >= least_breadth;
  });
  const std::span candidates(numbers.begin(), narrow);
  const glm::vec3 from = centre(bundle.from.corners(bundle.row_side));
  const glm::vec3 between = centre(bundle.to.corners(bundle.column_side)) - from;
  const float length = glm::length(between);
  const glm::vec3 axis = length > 0 ? between / length : glm::vec3(0);  // both hulls may be one
  struct Candidate {
    float reach;
    std::uint32_t number;
  };
  std::vector<Candidate> by_reach(candidates.size());
  std::ranges::transform(candidates, by_reach.begin(), [&](std::uint32_t number) {
    const ConvexBody& body = bodies[number];
    return Candidate{body.breadth - glm::length(glm::cross(body.centre - from, axis)), number};
  });
  const std::size_t count = std::min(most, by_reach.size());
  std::ranges::partial_sort(by_reach, by_reach.begin() + static_cast<std::ptrdiff_t>(count), std::greater(),
                            &Candidate::reach);
  std::ranges::transform(by_reach, candidates.begin(), &Candidate::number);
  return count;
}

}  // namespace fluxel
