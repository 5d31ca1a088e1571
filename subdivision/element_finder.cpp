#include "subdivision/element_finder.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <span>
#include <vector>

namespace fluxel {

namespace {

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
  grid_of_.assign(first_.size(), kNoGrid);
  for (std::size_t patch = 0; patch + 1 < first_.size(); ++patch) {
    const std::span<const std::uint32_t> of_patch = elements_of(patch);
    if (of_patch.size() <= kFewOutlines) continue;
    grid_of_[patch] = static_cast<std::uint32_t>(grids_.size());
    std::vector<PlaneGrid::Entry> entries;
    for (const std::uint32_t i : of_patch) entries.push_back(PlaneGrid::entry(mesh.outlines[i], margin_, i));
    grids_.emplace_back(entries, glm::dvec3(mesh.elements[of_patch[0]].normal));
  }
}

std::size_t ElementFinder::find(PatchId patch, const glm::dvec3& point) const {
  const std::size_t number = index(patch);
  if (number + 1 >= first_.size()) return kNone;
  Deepest deepest{mesh_, -2 * margin_};
  const std::uint32_t grid = grid_of_[number];
  for (const std::uint32_t i : grid == kNoGrid ? elements_of(number) : grids_[grid].around(point))
    deepest.look_at(i, point);
  return deepest.element;
}

}  // namespace fluxel
