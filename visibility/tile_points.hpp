#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/element.hpp"
#include "scene/scene.hpp"
#include "visibility/tile.hpp"

namespace fluxel {

/// Which side of an element: the index of arrays over both.
enum class Side : std::uint8_t { front = 0, back = 1 };
inline constexpr std::array kSides{Side::front, Side::back};
constexpr std::size_t index(Side side) { return static_cast<std::size_t>(side); }

/// A vector for each element of a tile, one coordinate an array, so long that lanes may be loaded from
/// anywhere.
struct alignas(64) TileVectors {
  static constexpr std::size_t kMaxLanes = 16;

  std::array<float, kTileSize + kMaxLanes> x{}, y{}, z{};

  void set(std::size_t k, const glm::vec3& v) { x[k] = v.x, y[k] = v.y, z[k] = v.z; }
  [[nodiscard]] glm::vec3 at(std::size_t k) const { return {x[k], y[k], z[k]}; }
};

/// Consecutive elements of a tile: [first, last). Those of one patch are bounded by a rectangle in its plane,
/// others by a box.
struct Cluster {
  std::uint32_t first = 0, last = 0;
  bool flat = false;
  std::array<std::array<glm::vec3, 8>, 2> hull;  ///< around the ends of rays, by side: 4 corners or 8

  [[nodiscard]] std::span<const glm::vec3> corners(Side side) const {
    return std::span(hull[index(side)]).first(flat ? 4 : 8);
  }
  [[nodiscard]] std::uint64_t mask() const { return low_bits(last - first) << first; }
};

/// A tile's elements as the ends of rays.
struct TilePoints {
  TileVectors centroid, normal;
  std::array<TileVectors, 2> lifted;  ///< ends of rays by side: off the plane, into that side's half-space
  std::array<std::uint64_t, 2> unknown{};  ///< by side: the elements whose side is an unknown
  std::vector<Cluster> clusters;           ///< all elements: long runs of one patch, and what lies between
};

/// The tile's points; `lift` [m] is how far rays begin and end off the planes of their elements.
[[nodiscard]] TilePoints tile_points(const Scene& scene, std::span<const Element> elements, std::size_t tile,
                                     float lift);

}  // namespace fluxel
