#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/element.hpp"
#include "subdivision/plane_grid.hpp"

namespace fluxel {

/// Which element of a mesh a point of a patch lies on: of a patch that has few elements by a look at each, of
/// others by a grid over its plane. Queries may run from many threads at once.
class ElementFinder {
 public:
  /// The mesh must outlive this.
  explicit ElementFinder(const ElementView& mesh);

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// The element of the patch that the point [m, recentred] lies deepest in, so that one on an edge, to
  /// within rounding, has an element too; kNone where the patch has none there, as under what covers it.
  [[nodiscard]] std::size_t find(PatchId patch, const glm::dvec3& point) const;

 private:
  struct Deepest;
  static constexpr std::uint32_t kNoGrid = 0xFFFFFFFFu;

  [[nodiscard]] std::span<const std::uint32_t> elements_of(std::size_t patch) const {
    return std::span(elements_).subspan(first_[patch], first_[patch + 1] - first_[patch]);
  }

  ElementView mesh_;
  std::vector<std::uint32_t> first_;     // of each patch in `elements_`, and their number
  std::vector<std::uint32_t> elements_;  // by patches, ascending in each
  std::vector<std::uint32_t> grid_of_;   // of each patch: which of `grids_`
  std::vector<PlaneGrid> grids_;
  double margin_ = 0;  // [m], of single precision
};

}  // namespace fluxel
