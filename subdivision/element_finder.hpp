#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "core/element.hpp"

namespace fluxel {

/// Which element of a mesh a point of a patch lies on: of a patch that has few elements by a look at each, of
/// others by an R-tree over their boxes. Queries may run from many threads at once.
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
  struct Deepest;
  ElementView mesh_;
  std::vector<std::uint32_t> first_;     // of each patch in `elements_`, and their number
  std::vector<std::uint32_t> elements_;  // by patches, ascending in each
  double margin_ = 0;                    // [m], of single precision
  std::unique_ptr<Tree> tree_;
};

}  // namespace fluxel
