#include "visibility/tile_points.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace fluxel {

namespace {

constexpr float kInfiniteFloat = std::numeric_limits<float>::infinity();
// Shorter runs of one patch are boxed together.
constexpr std::size_t kMinRun = 16;
// Of the scene's extent: more than the rounding of a centroid in single precision.
constexpr float kRounding = 16 * 0x1p-24f;

struct Bounds {
  glm::vec3 low{kInfiniteFloat}, high{-kInfiniteFloat};

  void add(const glm::vec3& x) { low = glm::min(low, x), high = glm::max(high, x); }
  void widen(float by) { low -= by, high += by; }
};

glm::vec3 corner(const Bounds& bounds, unsigned k) {
  return {(k & 1u) != 0 ? bounds.high.x : bounds.low.x, (k & 2u) != 0 ? bounds.high.y : bounds.low.y,
          (k & 4u) != 0 ? bounds.high.z : bounds.low.z};
}

/// A rectangle along the patch's first edge, lifted off its plane to both sides.
void bound_in_plane(const Patch& patch, std::span<const Element> own, float lift, float rounding,
                    Cluster& cluster) {
  const auto& outline = patch.outline.corner;
  const glm::vec3 n(patch.normal);
  const glm::vec3 u(glm::normalize(outline[1] - outline[0]));
  const glm::vec3 v = glm::cross(n, u);
  const glm::vec3 origin = own.front().centroid;
  Bounds bounds;
  for (const Element& element : own)
    bounds.add({glm::dot(u, element.centroid - origin), glm::dot(v, element.centroid - origin), 0});
  bounds.widen(rounding);
  cluster.flat = true;
  for (const Side side : kSides) {
    const glm::vec3 base = origin + (side == Side::front ? lift : -lift) * n;
    for (unsigned k = 0; k < 4; ++k) {
      // Around the rectangle: corners 0, 1, 3, 2 of the bounds.
      const glm::vec3 at = corner(bounds, k ^ (k >> 1));
      cluster.hull[index(side)][k] = base + at.x * u + at.y * v;
    }
  }
}

void bound_in_space(std::span<const Element> own, float lift, float rounding, Cluster& cluster) {
  for (const Side side : kSides) {
    Bounds bounds;
    for (const Element& element : own)
      bounds.add(element.centroid + (side == Side::front ? lift : -lift) * element.normal);
    bounds.widen(rounding);
    for (unsigned k = 0; k < 8; ++k) cluster.hull[index(side)][k] = corner(bounds, k);
  }
}

bool of_one_patch(std::span<const Element> own) {
  return std::ranges::all_of(own, [&](const Element& e) { return e.patch == own.front().patch; });
}

Cluster make_cluster(const Scene& scene, std::span<const Element> tile, std::size_t first, std::size_t last,
                     float lift) {
  const auto own = tile.subspan(first, last - first);
  const float rounding = kRounding * static_cast<float>(scene.extent);
  Cluster cluster;
  cluster.first = static_cast<std::uint32_t>(first);
  cluster.last = static_cast<std::uint32_t>(last);
  if (of_one_patch(own)) {
    bound_in_plane(scene.patch(own.front().patch), own, lift, rounding, cluster);
  } else {
    bound_in_space(own, lift, rounding, cluster);
  }
  return cluster;
}

/// Ends of the clusters: long runs of one patch stand alone, the short ones between them are joined.
std::vector<std::size_t> cluster_ends(std::span<const Element> tile) {
  std::vector<std::size_t> ends;
  std::size_t joined = 0;  // elements of short runs that wait
  for (std::size_t first = 0; first < tile.size();) {
    std::size_t last = first + 1;
    while (last < tile.size() && tile[last].patch == tile[first].patch) ++last;
    if (last - first >= kMinRun) {
      if (joined > 0) ends.push_back(first);
      ends.push_back(last);
      joined = 0;
    } else {
      joined += last - first;
    }
    first = last;
  }
  if (joined > 0) ends.push_back(tile.size());
  return ends;
}

}  // namespace

TilePoints tile_points(const Scene& scene, std::span<const Element> elements, std::size_t tile, float lift) {
  const std::size_t count = rows_of_tile(tile, elements.size());
  const auto own = elements.subspan(tile * kTileSize, count);
  TilePoints points;
  for (std::size_t k = 0; k < count; ++k) {
    const Element& element = own[k];
    points.centroid.set(k, element.centroid);
    points.normal.set(k, element.normal);
    points.lifted[0].set(k, element.centroid + lift * element.normal);
    points.lifted[1].set(k, element.centroid - lift * element.normal);
    points.unknown[0] |= std::uint64_t{(element.sides & kFront) != 0} << k;
    points.unknown[1] |= std::uint64_t{(element.sides & kBack) != 0} << k;
  }
  std::size_t first = 0;
  for (const std::size_t last : cluster_ends(own)) {
    points.clusters.push_back(make_cluster(scene, own, first, last, lift));
    first = last;
  }
  return points;
}

}  // namespace fluxel
