#include "subdivision/element_finder.hpp"

#include <algorithm>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>
#include <vector>

namespace fluxel {

namespace {

namespace bg = boost::geometry;
using Point = bg::model::point<double, 3, bg::cs::cartesian>;
using Box = bg::model::box<Point>;
using Entry = std::pair<Box, std::uint32_t>;

Point to_point(const glm::dvec3& x) { return {x.x, x.y, x.z}; }

/// Distance of a point of the plane from the nearest edge [m], negative outside.
double depth_inside(const Outline<glm::vec3>& outline, const glm::dvec3& normal, const glm::dvec3& point) {
  double depth = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < outline.corners; ++k) {
    const glm::dvec3 from(outline.corner[k]);
    const glm::dvec3 inward =
        glm::cross(normal, glm::dvec3(outline.corner[(k + 1) % outline.corners]) - from);
    const double length = glm::length(inward);
    if (length > 0) depth = std::min(depth, glm::dot(point - from, inward) / length);
  }
  return depth;
}

}  // namespace

struct ElementFinder::Tree {
  bg::index::rtree<Entry, bg::index::linear<16>> boxes;
};

ElementFinder::ElementFinder(const ElementView& mesh) : mesh_(mesh) {
  float extent = 0;
  for (const Outline<glm::vec3>& outline : mesh.outlines)
    for (std::size_t k = 0; k < outline.corners; ++k) {
      const glm::vec3 size = glm::abs(outline.corner[k]);
      extent = std::max({extent, size.x, size.y, size.z});
    }
  margin_ = 4 * static_cast<double>(extent * std::numeric_limits<float>::epsilon());
  std::vector<Entry> entries;
  entries.reserve(mesh.outlines.size());
  for (std::size_t i = 0; i < mesh.outlines.size(); ++i) {
    const Outline<glm::vec3>& outline = mesh.outlines[i];
    glm::dvec3 low(outline.corner[0]), high = low;
    for (std::size_t k = 1; k < outline.corners; ++k) {
      low = glm::min(low, glm::dvec3(outline.corner[k]));
      high = glm::max(high, glm::dvec3(outline.corner[k]));
    }
    entries.emplace_back(Box(to_point(low - margin_), to_point(high + margin_)),
                         static_cast<std::uint32_t>(i));
  }
  tree_ = std::make_unique<Tree>(Tree{decltype(Tree::boxes)(entries)});
}

ElementFinder::~ElementFinder() = default;

std::size_t ElementFinder::find(PatchId patch, const glm::dvec3& point) const {
  std::size_t best = kNone;
  double best_depth = -2 * margin_;
  for (auto at = tree_->boxes.qbegin(bg::index::intersects(Box(to_point(point), to_point(point))));
       at != tree_->boxes.qend(); ++at) {
    const std::size_t i = at->second;
    if (mesh_.elements[i].patch != patch) continue;
    const double depth = depth_inside(mesh_.outlines[i], glm::dvec3(mesh_.elements[i].normal), point);
    // On an edge of two the lower one has the point, in whatever order the tree finds them.
    if (depth > best_depth || (depth == best_depth && i < best)) {
      best = i;
      best_depth = depth;
    }
  }
  return best;
}

}  // namespace fluxel
