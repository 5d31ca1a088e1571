#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/element.hpp"
#include "visibility/convex_body.hpp"
#include "visibility/occlusion.hpp"
#include "visibility/ray_scene.hpp"
#include "visibility/tile_points.hpp"
#include "visibility/traced_tile.hpp"

namespace fluxel {

/// Whether a pair may be settled without its ray; the bits are the same.
enum class Shortcuts : std::uint8_t { on, off };

/// Finds which elements see each other, tile after tile. A bit is set where unknown sides of both elements
/// face each other and the segment between the centroids, lifted off their planes by the ray scene's
/// surface_epsilon and run from the lower to the higher element, meets no patch. Elements of one plane never
/// see each other. A tile on the diagonal is symmetric.
///
/// Clusters of a tile's elements are looked at before their pairs: the convex bodies and polygons that may
/// stand in the shaft between two clusters are listed. Pairs are tested against those that are likely to hide
/// most, and what is left against the whole list, where that costs less than rays. Rays are traced for the
/// rest, and for what single precision leaves unsure.
class TileTracer {
 public:
  /// The ray scene, of all patches, must outlive this; the elements are copied as far as they are needed.
  TileTracer(const RayScene& ray_scene, std::span<const Element> elements,
             Shortcuts shortcuts = Shortcuts::on);

  /// Of the pairs (row_tile, column_tile), column_tile >= row_tile. May run from many threads at once.
  [[nodiscard]] TracedTile trace(std::size_t row_tile, std::size_t column_tile) const;

  [[nodiscard]] std::size_t elements() const { return elements_; }

 private:
  struct Facing;

  [[nodiscard]] Facing find_facing(std::size_t row_tile, std::size_t column_tile) const;
  [[nodiscard]] Occlusion occlude_tile(std::size_t row_tile, std::size_t column_tile, Side row_side,
                                       Side column_side, const TileBits& rays) const;
  void occlude_bundle(const RayBundle& bundle, const TileBits& rays, std::vector<std::uint32_t>& numbers,
                      Occlusion& occlusion) const;

  const RayScene& ray_scene_;
  std::size_t elements_;
  float extent_;
  Shortcuts shortcuts_;
  BodyTree tree_;
  std::vector<TilePoints> points_;
};

}  // namespace fluxel
