#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "core/element.hpp"
#include "visibility/convex_body.hpp"

namespace fluxel {

/// Tells of pairs of elements whose centroids do not see each other, and of pairs of tiles without any that
/// do, whether a single convex body hides all of one from all of the other. Neighbours are mostly hidden by
/// the same one, which is tried first.
class HiddenPairs {
 public:
  /// The corners of the box around the elements' outlines [m].
  using TileCorners = std::array<glm::dvec3, 8>;
  [[nodiscard]] static TileCorners tile_corners(const ElementView& mesh, std::size_t tile);

  /// All must outlive this. `tiles`: the corners of all tiles; what is nearer to each other than `epsilon`
  /// [m] touches.
  HiddenPairs(const BodyTree& bodies, const ElementView& mesh, std::span<const TileCorners> tiles,
              double epsilon)
      : bodies_(bodies), mesh_(mesh), tiles_(tiles), epsilon_(epsilon) {}

  /// True only where a body on the way between the centroids meets every segment between i and j. From each
  /// point the shadow of a convex body is convex: all segments meet it where those between the corners do.
  [[nodiscard]] bool hidden(std::size_t i, std::size_t j);

  /// The same of all elements of two tiles, the way being that between their first elements.
  [[nodiscard]] bool hidden_tiles(std::size_t row, std::size_t column);

 private:
  using Corners = std::span<const glm::dvec3>;
  [[nodiscard]] bool hidden(Corners a, Corners b, std::size_t i, std::size_t j);
  [[nodiscard]] bool hides(const ConvexBody& body, Corners a, Corners b) const;

  static constexpr std::uint32_t kNone = 0xffffffff;

  const BodyTree& bodies_;
  const ElementView& mesh_;
  std::span<const TileCorners> tiles_;
  double epsilon_;
  std::uint32_t last_ = kNone;
};

}  // namespace fluxel
