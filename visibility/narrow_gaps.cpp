#include "visibility/narrow_gaps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

#include "core/sampling.hpp"
#include "scene/scene.hpp"

namespace fluxel {

namespace {

/// Of an element's length.
constexpr double kNarrow = 1.0 / 3;

/// Cosine between a ray and the normal of what it meets, above which that lies opposite: where surfaces meet
/// in an edge, as under a roof, elements of any size are as long as their distance.
constexpr double kOpposite = 0.9;

/// Along each edge.
constexpr std::size_t kAlongEdge = 3;

double longest_edge(const Outline<glm::vec3>& outline) {
  double longest = 0;
  for (std::size_t k = 0; k < outline.corners; ++k)
    longest = std::max(longest, static_cast<double>(glm::distance(
                                    outline.corner[k], outline.corner[(k + 1) % outline.corners])));
  return longest;
}

struct OfPair {
  double light = 0, width = 0, length = 0;
};

}  // namespace

NarrowGaps find_narrow_gaps(const RayScene& ray_scene, const ElementView& mesh, std::span<const Rgb> H) {
  const Scene& scene = ray_scene.scene();
  const double least = least_gap(scene);
  double all = 0, narrow = 0;
  std::map<std::pair<std::uint32_t, std::uint32_t>, OfPair> pairs;
  for (std::size_t k = 0; k < H.size(); ++k) {
    const std::size_t i = k % mesh.elements.size();
    const Element& element = mesh.elements[i];
    const double light = static_cast<double>(element.area) * mean_of_colours(glm::abs(H[k]));
    if (!(light > 0)) continue;
    all += light;
    const double length = longest_edge(mesh.outlines[i]);
    const glm::dvec3 up = (k < mesh.elements.size() ? 1.0 : -1.0) * glm::dvec3(element.normal);
    for (std::size_t place = 0; place < kAlongEdge * kAlongEdge; ++place) {
      const auto at = [](std::size_t n) { return (static_cast<double>(n) + 0.5) / kAlongEdge; };
      const glm::dvec3 point =
          surface_point(mesh.outlines[i], at(place % kAlongEdge), at(place / kAlongEdge));
      const PatchHit hit = ray_scene.first_hit(point + least * up, up);
      if (hit.patch == kNoPatch || hit.patch == element.patch || hit.t > kNarrow * length) continue;
      const Patch& other = scene.patch(hit.patch);
      const double towards = glm::dot(other.normal, up);
      if (std::abs(towards) < kOpposite || (other.sides & (towards < 0 ? kFront : kBack)) == 0) continue;
      const double part = light / (kAlongEdge * kAlongEdge);
      narrow += part;
      OfPair& pair = pairs[{index(scene.patch(element.patch).group), index(scene.patch(hit.patch).group)}];
      if (!(pair.light > 0) || hit.t + least < pair.width) pair.width = hit.t + least;
      pair.light += part;
      pair.length = std::max(pair.length, length);
    }
  }
  if (!(narrow > 0)) return {};
  const auto& [groups, worst] =
      *std::ranges::max_element(pairs, {}, [](const auto& entry) { return entry.second.light; });
  return {narrow / all, scene.groups[groups.first], scene.groups[groups.second], worst.width, worst.length};
}

}  // namespace fluxel
