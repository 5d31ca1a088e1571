#include "formfactor/hidden_pairs.hpp"

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <glm/geometric.hpp>
#include <iterator>
#include <vector>

#include "visibility/cuts_off.hpp"
#include "visibility/shaft.hpp"
#include "visibility/tile.hpp"

namespace fluxel {

namespace {

/// Heights over a body's faces, of points that are all outside of one of them.
using Heights = std::array<std::array<double, ConvexBody::kMaxFaces>, kMaxCutCorners>;

/// False where a point is not clear of the body: what lies on its surface may look in.
bool find_heights(const ConvexBody& body, std::span<const glm::dvec3> points, double epsilon,
                  Heights& heights) {
  for (std::size_t k = 0; k < points.size(); ++k) {
    bool outside = false;
    for (std::uint32_t face = 0; face < body.faces; ++face) {
      heights[k][face] = glm::dot(glm::dvec3(body.normal[face]), points[k] - glm::dvec3(body.base[face]));
      outside = outside || heights[k][face] > epsilon;
    }
    if (!outside) return false;
  }
  return true;
}

/// Whether the segment between two points with these heights passes through the body.
bool meets(std::span<const double> from, std::span<const double> to) {
  double first = 0, last = 1;
  for (std::size_t face = 0; face < from.size(); ++face) {
    if (from[face] > 0 && to[face] > 0) return false;
    if (from[face] > 0)
      first = std::max(first, from[face] / (from[face] - to[face]));
    else if (to[face] > 0)
      last = std::min(last, from[face] / (from[face] - to[face]));
  }
  return first < last;
}

/// Whether all segments between two convex bodies with these corners pass through another.
bool meets_all(const ConvexBody& body, std::span<const glm::dvec3> a, std::span<const glm::dvec3> b,
               double epsilon) {
  Heights of_a, of_b;
  if (!find_heights(body, a, epsilon, of_a) || !find_heights(body, b, epsilon, of_b)) return false;
  for (std::size_t k = 0; k < a.size(); ++k)
    for (std::size_t l = 0; l < b.size(); ++l)
      if (!meets(std::span(of_a[k]).first(body.faces), std::span(of_b[l]).first(body.faces))) return false;
  return true;
}

}  // namespace

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
  if (last_ != kNone && hides(bodies_.bodies()[last_], a, b)) return true;
  const glm::dvec3 from(mesh_.elements[i].centroid), way = glm::dvec3(mesh_.elements[j].centroid) - from;
  const auto on_the_way = [&](const glm::vec3& low, const glm::vec3& high) {
    double first = 0, last = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double least = static_cast<double>(low[axis]) - epsilon_ - from[axis];
      const double most = static_cast<double>(high[axis]) + epsilon_ - from[axis];
      if (way[axis] == 0) {
        if (least > 0 || most < 0) return false;
        continue;
      }
      const double at_least = least / way[axis], at_most = most / way[axis];
      first = std::max(first, std::min(at_least, at_most));
      last = std::min(last, std::max(at_least, at_most));
    }
    return first <= last;
  };
  return bodies_.search(on_the_way, [&](std::uint32_t number) {
    if (number == last_ || !hides(bodies_.bodies()[number], a, b)) return false;
    last_ = number;
    return true;
  });
}

bool HiddenPairs::hides(const ConvexBody& body, Corners a, Corners b) const {
  if (body.is_flat()) {
    boost::container::static_vector<glm::dvec3, ConvexBody::kMaxCorners> outline;
    for (std::uint32_t k = 0; k < body.corners; ++k) outline.emplace_back(body.corner[k]);
    return cuts_off(a, b, {outline.data(), outline.size()}, epsilon_);
  }
  return meets_all(body, a, b, epsilon_);
}

}  // namespace fluxel
