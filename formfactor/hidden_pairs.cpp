#include "formfactor/hidden_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <vector>

#include "visibility/cuts_off.hpp"
#include "visibility/shaft.hpp"
#include "visibility/tile.hpp"

namespace fluxel {

HiddenPairs::TileCorners HiddenPairs::tile_corners(const ElementView& mesh, std::size_t tile) {
  std::vector<glm::dvec3> points;
  const std::size_t first = tile * kTileSize;
  for (std::size_t i = first; i < first + rows_of_tile(tile, mesh.elements.size()); ++i)
    std::ranges::copy(corners(widen(mesh.outlines[i])), std::back_inserter(points));
  return corners_of(bounds(points));
}

bool HiddenPairs::hidden(std::size_t i, std::size_t j) {
  const Outline<glm::dvec3> a = widen(mesh_.outlines[i]), b = widen(mesh_.outlines[j]);
  return hidden(corners(a), corners(b), i, j);
}

bool HiddenPairs::hidden_tiles(std::size_t row, std::size_t column) {
  return hidden(tiles_[row], tiles_[column], row * kTileSize, column * kTileSize);
}

bool HiddenPairs::hidden(Corners a, Corners b, std::size_t i, std::size_t j) {
  const auto epsilon = static_cast<double>(ray_scene_.surface_epsilon());
  const auto hides = [&](PatchId patch) {
    return patch != kNoPatch && cuts_off(a, b, ray_scene_.scene().patch(patch).outline, epsilon);
  };
  if (hides(last_)) return true;
  for (const auto& [from, to] : {std::array{i, j}, std::array{j, i}}) {
    const PatchId patch = first_between(from, to);
    if (patch == last_ || !hides(patch)) continue;
    last_ = patch;
    return true;
  }
  return false;
}

PatchId HiddenPairs::first_between(std::size_t from, std::size_t to) const {
  const Element &start = mesh_.elements[from], &end = mesh_.elements[to];
  const glm::dvec3 direction = glm::dvec3(end.centroid) - glm::dvec3(start.centroid);
  const glm::dvec3 normal(start.normal);
  const double lift =
      std::copysign(static_cast<double>(ray_scene_.surface_epsilon()), glm::dot(normal, direction));
  const PatchHit hit = ray_scene_.first_hit(glm::dvec3(start.centroid) + lift * normal, direction);
  return hit.t < 1 ? hit.patch : kNoPatch;
}

}  // namespace fluxel
