#include "subdivision/element_finder.hpp"

#include <algorithm>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <span>
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

/// A patch of more elements is looked up in the tree.
constexpr std::size_t kFew = 8;

}  // namespace

struct ElementFinder::Tree {
  bg::index::rtree<Entry, bg::index::linear<16>> boxes;
};

/// Of elements that are looked at in any order.
struct ElementFinder::Deepest {
  const ElementView& mesh;
  double depth;
  std::size_t element = kNone;

  void look_at(std::size_t i, const glm::dvec3& point) {
    const double other = depth_inside(mesh.outlines[i], glm::dvec3(mesh.elements[i].normal), point);
    // On an edge of two the lower one has the point.
    if (other > depth || (other == depth && i < element)) {
      element = i;
      depth = other;
    }
  }
};

ElementFinder::ElementFinder(const ElementView& mesh) : mesh_(mesh) {
  float extent = 0;
  for (const Outline<glm::vec3>& outline : mesh.outlines)
    for (std::size_t k = 0; k < outline.corners; ++k) {
      const glm::vec3 size = glm::abs(outline.corner[k]);
      extent = std::max({extent, size.x, size.y, size.z});
    }
  margin_ = 4 * static_cast<double>(extent * std::numeric_limits<float>::epsilon());
  for (const Element& element : mesh.elements)
    first_.resize(std::max<std::size_t>(first_.size(), index(element.patch) + 2));
  for (const Element& element : mesh.elements) ++first_[index(element.patch) + 1];
  for (std::size_t patch = 1; patch < first_.size(); ++patch) first_[patch] += first_[patch - 1];
  elements_.resize(mesh.elements.size());
  std::vector<std::uint32_t> next = first_;
  for (std::size_t i = 0; i < mesh.elements.size(); ++i)
    elements_[next[index(mesh.elements[i].patch)]++] = static_cast<std::uint32_t>(i);
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < mesh.outlines.size(); ++i) {
    const std::size_t patch = index(mesh.elements[i].patch);
    if (first_[patch + 1] - first_[patch] <= kFew) continue;
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
  const std::size_t number = index(patch);
  if (number + 1 >= first_.size()) return kNone;
  Deepest deepest{mesh_, -2 * margin_};
  const std::span of_patch =
      std::span(elements_).subspan(first_[number], first_[number + 1] - first_[number]);
  if (of_patch.size() <= kFew) {
    for (const std::uint32_t i : of_patch) deepest.look_at(i, point);
    return deepest.element;
  }
  for (auto at = tree_->boxes.qbegin(bg::index::intersects(Box(to_point(point), to_point(point))));
       at != tree_->boxes.qend(); ++at)
    if (mesh_.elements[at->second].patch == patch) deepest.look_at(at->second, point);
  return deepest.element;
}

}  // namespace fluxel
