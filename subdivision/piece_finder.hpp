#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/ids.hpp"
#include "scene/scene.hpp"
#include "subdivision/plane_grid.hpp"

namespace fluxel {

/// Finds the piece of a patch that a point lies in: of pieces that share a cut the one it lies deepest in.
/// Queries may run from many threads at once.
class PieceFinder {
 public:
  /// The scene must outlive this.
  explicit PieceFinder(const Scene& scene);

  /// Of a patch that has no pieces, as one that is narrow and only stands in the way of light.
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// The point lies in the patch's plane.
  [[nodiscard]] std::size_t find(PatchId patch, const glm::dvec3& point) const;

 private:
  const Scene& scene_;
  std::vector<std::uint32_t> first_, count_;  // of each patch's pieces, which stand together
  std::vector<std::uint32_t> grid_of_;        // of patches that have many
  std::vector<PlaneGrid> grids_;
};

}  // namespace fluxel
