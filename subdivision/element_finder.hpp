#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <memory>

#include "core/element.hpp"

namespace fluxel {

/// Which element of a mesh a point of a patch lies on, by an R-tree over the elements' boxes. Queries may run
/// from many threads at once.
class ElementFinder {
 public:
  /// The mesh must outlive this.
  explicit ElementFinder(const ElementView& mesh);
  ~ElementFinder();
  ElementFinder(const ElementFinder&) = delete;
  ElementFinder& operator=(const ElementFinder&) = delete;

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// The element of the patch that the point [m, recentred] lies deepest in, so that one on an edge, to
  /// within rounding, has an element too; kNone where the patch has none there, as under what covers it.
  [[nodiscard]] std::size_t find(PatchId patch, const glm::dvec3& point) const;

 private:
  struct Tree;
  ElementView mesh_;
  double margin_ = 0;  // [m], of single precision
  std::unique_ptr<Tree> tree_;
};

}  // namespace fluxel
