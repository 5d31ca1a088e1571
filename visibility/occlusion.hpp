#pragma once

#include <bit>
#include <span>

#include "visibility/convex_body.hpp"
#include "visibility/tile.hpp"
#include "visibility/tile_points.hpp"

namespace fluxel {

/// Rays from one side of a cluster of rows to one side of a cluster of columns.
struct RayBundle {
  const TilePoints& rows;
  const TilePoints& columns;
  const Cluster& from;
  const Cluster& to;
  Side row_side{}, column_side{};
  float extent = 0;  ///< [m], of the scene
};

/// What some bodies do to the rays of a tile. Word r, bit c stand for the ray from row r to column c.
struct Occlusion {
  TileBits blocked{};  ///< certainly
  TileBits unsure{};   ///< so near an edge or a plane that rounding decides; some are blocked all the same
};

/// Whether a tile has rays from the cluster `from` of its rows to the cluster `to` of its columns.
[[nodiscard]] inline bool any_ray(const Cluster& from, const Cluster& to, const TileBits& rays) {
  std::uint64_t some = 0;
  for (std::size_t r = from.first; r < from.last; ++r) some |= rays[r];
  return (some & to.mask()) != 0;
}

/// How many those are.
[[nodiscard]] inline std::size_t count_rays(const Cluster& from, const Cluster& to, const TileBits& rays) {
  std::size_t count = 0;
  for (std::size_t r = from.first; r < from.last; ++r)
    count += static_cast<std::size_t>(std::popcount(rays[r] & to.mask()));
  return count;
}

/// Adds these rays to `sum`.
inline void add_rays(const Cluster& from, const Cluster& to, const TileBits& rays, TileBits& sum) {
  for (std::size_t r = from.first; r < from.last; ++r) sum[r] |= rays[r] & to.mask();
}

/// So many bodies may stand in a bundle; with more, tracing rays is faster.
inline constexpr std::size_t kMaxBodies = 128;

/// Tests those rays of the bundle whose bits are set in `rays` against the bodies with these numbers, at most
/// kMaxBodies, and adds to `result`. A ray that ends up neither blocked nor unsure passes them all.
/// What is certain is so for visibility/segment_test too, whose turns are these volumes times the ray's
/// length along an axis: inequalities hold by more than the rounding of either.
///
/// A ray meets a convex polygon where it crosses its plane and passes all edges on the inner side, that is,
/// where the tetrahedra over the ray and each edge have volumes of one sign (Pluecker's side relation, as in
/// Shoemake 1998, "Pluecker coordinate tutorial"). It meets a convex body where it passes so all edges of the
/// outline that the body has from the ray's origin, and ends behind all faces that are turned to it. From one
/// origin these are planes through the edges, which cost three products and sums a ray and edge.
void occlude(const RayBundle& bundle, std::span<const ConvexBody> bodies,
             std::span<const std::uint32_t> numbers, const TileBits& rays, Occlusion& result);

}  // namespace fluxel
