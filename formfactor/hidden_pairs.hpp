#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <span>

#include "core/element.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// Tells of pairs of elements whose centroids do not see each other, and of pairs of tiles of which no such
/// pair sees the other, whether a single patch hides all of one from all of the other. Neighbours are mostly
/// hidden by the same patch, which is tried first.
class HiddenPairs {
 public:
  /// The corners of the box around the elements' outlines [m].
  using TileCorners = std::array<glm::dvec3, 8>;
  [[nodiscard]] static TileCorners tile_corners(const ElementView& mesh, std::size_t tile);

  /// All must outlive this. `tiles`: the corners of all tiles.
  HiddenPairs(const RayScene& ray_scene, const ElementView& mesh, std::span<const TileCorners> tiles)
      : ray_scene_(ray_scene), mesh_(mesh), tiles_(tiles) {}

  /// Forgets the pairs before.
  void restart() { last_ = kNoPatch; }

  /// True only where a patch cuts every segment between i and j (visibility/cuts_off): that of the pair
  /// before, or the first on the way from one centroid to the other.
  [[nodiscard]] bool hidden(std::size_t i, std::size_t j);

  /// The same of all elements of two tiles, the way being that between their first elements.
  [[nodiscard]] bool hidden_tiles(std::size_t row, std::size_t column);

 private:
  using Corners = std::span<const glm::dvec3>;
  [[nodiscard]] bool hidden(Corners a, Corners b, std::size_t i, std::size_t j);
  [[nodiscard]] PatchId first_between(std::size_t from, std::size_t to) const;

  const RayScene& ray_scene_;
  const ElementView& mesh_;
  std::span<const TileCorners> tiles_;
  PatchId last_ = kNoPatch;
};

}  // namespace fluxel
