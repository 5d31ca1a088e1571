#include "scene/coplanar_regions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "scene/polygon.hpp"

namespace fluxel {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;

/// Uses of one edge that are looked at: two sheets, each with patches of its own on both faces, that cross.
constexpr std::size_t kMaxUses = 8;

/// Edge `edge` of a patch, between two places.
struct RegionEdge {
  std::uint32_t low, high, patch, edge;
  bool ascending;
};

using Links = std::vector<std::array<std::uint32_t, 4>>;  // of each edge of each patch: the patch beyond

class RegionFinder {
 public:
  RegionFinder(const Scene& scene, const PatchMesh& mesh, const MergeTolerance& tolerance)
      : scene_(scene), mesh_(mesh), tolerance_(tolerance), links_(find_links()) {}

  std::vector<std::vector<std::uint32_t>> find() {
    std::vector<std::vector<std::uint32_t>> regions;
    found_.assign(scene_.patches.size(), false);
    std::vector<bool> met(scene_.patches.size(), false);
    for (std::uint32_t patch = 0; patch < scene_.patches.size(); ++patch) {
      if (met[patch]) continue;
      std::vector<std::uint32_t> linked = flood(patch, met, std::nullopt);
      if (linked.size() < 2) continue;
      if (lies_in(linked, common_plane(linked))) {
        regions.push_back(std::move(linked));
      } else {
        add_around_largest(std::move(linked), regions);
      }
    }
    std::ranges::sort(regions, {}, [](const auto& region) { return region.front(); });
    return regions;
  }

 private:
  [[nodiscard]] PolygonView outline(std::uint32_t patch) const {
    return corners(scene_.patches[patch].outline);
  }

  /// A patch whose corners are places of their own, and where it has them.
  [[nodiscard]] bool keeps_its_corners(std::uint32_t patch) const {
    const PolygonView polygon = outline(patch);
    const auto& places = mesh_.outlines[patch].corner;
    double longest = 0, farthest = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      longest = std::max(longest, glm::distance(polygon[i], polygon[(i + 1) % polygon.size()]));
      farthest = std::max(farthest, glm::distance(polygon[i], mesh_.places[places[i]]));
      for (std::size_t j = 0; j < i; ++j) {
        if (places[i] == places[j]) return false;
      }
    }
    return farthest <= tolerance_.outline(longest);
  }

  [[nodiscard]] std::vector<RegionEdge> edge_uses() const {
    std::vector<RegionEdge> uses;
    for (std::uint32_t patch = 0; patch < scene_.patches.size(); ++patch) {
      if (!keeps_its_corners(patch)) continue;
      const Outline<std::uint32_t>& places = mesh_.outlines[patch];
      for (std::uint32_t edge = 0; edge < places.corners; ++edge) {
        const std::uint32_t from = places.corner[edge], to = places.corner[(edge + 1) % places.corners];
        uses.push_back({std::min(from, to), std::max(from, to), patch, edge, from < to});
      }
    }
    std::ranges::sort(
        uses, {}, [](const RegionEdge& use) { return std::tuple(use.low, use.high, use.patch, use.edge); });
    return uses;
  }

  [[nodiscard]] bool lies_in(std::uint32_t patch, const Plane& plane) const {
    if (glm::dot(scene_.patches[patch].normal, plane.normal) <= 0) return false;
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const glm::dvec3& x : outline(patch)) {
      least = std::min(least, plane.distance(x));
      most = std::max(most, plane.distance(x));
    }
    return std::max(-least, most) <= tolerance_.touching &&
           most - least <= tolerance_.tilt(width(outline(patch), scene_.patches[patch].normal));
  }

  [[nodiscard]] bool lies_in(std::span<const std::uint32_t> patches, const Plane& plane) const {
    return std::ranges::all_of(patches, [&](std::uint32_t patch) { return lies_in(patch, plane); });
  }

  /// The smaller in the plane of the larger, which is known better.
  [[nodiscard]] bool may_join(const RegionEdge& a, const RegionEdge& b) const {
    const Patch &first = scene_.patches[a.patch], &second = scene_.patches[b.patch];
    if (a.ascending == b.ascending || a.patch == b.patch || first.material != second.material ||
        first.group != second.group)
      return false;
    const bool first_larger = first.area >= second.area;
    const Patch& larger = first_larger ? first : second;
    return lies_in(first_larger ? b.patch : a.patch, {larger.outline.corner[0], larger.normal});
  }

  [[nodiscard]] Links find_links() const {
    Links links(scene_.patches.size(), {kNone, kNone, kNone, kNone});
    const std::vector<RegionEdge> uses = edge_uses();
    for (std::size_t first = 0, last = 0; first < uses.size(); first = last) {
      while (last < uses.size() && uses[last].low == uses[first].low && uses[last].high == uses[first].high)
        ++last;
      if (last - first < 2 || last - first > kMaxUses) continue;
      const std::span edge(uses.data() + first, last - first);
      const auto partner = [&](const RegionEdge& use) -> const RegionEdge* {
        const RegionEdge* found = nullptr;
        for (const RegionEdge& other : edge) {
          if (!may_join(use, other)) continue;
          if (found != nullptr) return nullptr;
          found = &other;
        }
        return found;
      };
      for (const RegionEdge& use : edge) {
        const RegionEdge* other = partner(use);
        if (other != nullptr && partner(*other) == &use) links[use.patch][use.edge] = other->patch;
      }
    }
    return links;
  }

  /// What hangs together with `seed` and has not been met, all of it or what lies in a plane.
  std::vector<std::uint32_t> flood(std::uint32_t seed, std::vector<bool>& met,
                                   const std::optional<Plane>& plane) const {
    std::vector<std::uint32_t> region{seed};
    met[seed] = true;
    for (std::size_t i = 0; i < region.size(); ++i) {
      for (const std::uint32_t next : links_[region[i]]) {
        if (next == kNone || met[next] || (plane && !lies_in(next, *plane))) continue;
        met[next] = true;
        region.push_back(next);
      }
    }
    std::ranges::sort(region);
    return region;
  }

  [[nodiscard]] Plane common_plane(std::span<const std::uint32_t> patches) const {
    glm::dvec3 sum{0}, middle{0};
    double total = 0;
    for (const std::uint32_t patch : patches) {
      const double area = scene_.patches[patch].area;
      sum += area * scene_.patches[patch].normal;
      middle += area * centroid(outline(patch));
      total += area;
    }
    const double length = glm::length(sum);
    return {middle / total, length > 0 ? sum / length : sum};
  }

  void add_around_largest(std::vector<std::uint32_t> patches,
                          std::vector<std::vector<std::uint32_t>>& regions) {
    std::ranges::sort(patches, {},
                      [&](std::uint32_t patch) { return std::tuple(-scene_.patches[patch].area, patch); });
    for (const std::uint32_t patch : patches) {
      if (found_[patch]) continue;
      const Patch& seed = scene_.patches[patch];
      std::vector<std::uint32_t> region = flood(patch, found_, Plane{seed.outline.corner[0], seed.normal});
      if (region.size() > 1) regions.push_back(std::move(region));
    }
  }

  const Scene& scene_;
  const PatchMesh& mesh_;
  const MergeTolerance& tolerance_;
  Links links_;
  std::vector<bool> found_;  ///< of those that fall into sets around the largest
};

}  // namespace

std::vector<std::vector<std::uint32_t>> coplanar_regions(const Scene& scene, const PatchMesh& mesh,
                                                         const MergeTolerance& tolerance) {
  return RegionFinder(scene, mesh, tolerance).find();
}

}  // namespace fluxel
