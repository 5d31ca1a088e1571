#include "scene/contact_pairs.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

namespace fluxel {
namespace {

namespace bg = boost::geometry;
using Point = bg::model::point<double, 3, bg::cs::cartesian>;
using Box = bg::model::box<Point>;
using Entry = std::pair<Box, std::uint32_t>;
using Tree = bg::index::rtree<Entry, bg::index::linear<16>>;

Box box_around(PolygonView polygon, double margin) {
  glm::dvec3 low = polygon[0], high = polygon[0];
  for (const glm::dvec3& x : polygon) {
    low = glm::min(low, x);
    high = glm::max(high, x);
  }
  low -= margin;
  high += margin;
  return {{low.x, low.y, low.z}, {high.x, high.y, high.z}};
}

/// Of the tolerance: what is nearer lies there by rounding.
constexpr double kPlain = 0.1;

/// Of the width of what hovers: in so narrow a gap it is dark but for a margin.
constexpr double kNarrowGap = 0.125;

/// Distances of a patch's corners from another's plane.
struct Distances {
  Distances(PolygonView polygon, const Patch& other) {
    const Plane plane{other.outline.corner[0], other.normal};
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      value[i] = plane.distance(polygon[i]);
      least = std::min(least, value[i]);
      most = std::max(most, value[i]);
    }
  }
  [[nodiscard]] bool apart(double tolerance) const { return least > tolerance || most < -tolerance; }
  [[nodiscard]] bool in_plane(double tolerance) const { return least >= -tolerance && most <= tolerance; }

  std::array<double, 4> value{};
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
};

/// Where a patch meets the plane that the distances are from. Corners within `tolerance` count as on the
/// plane and edges are interpolated only between corners beyond it, so that two planes at a tiny angle, whose
/// line of intersection is ill-conditioned, still give points of the patch.
std::optional<Segment> section(PolygonView polygon, const Distances& distances, double tolerance) {
  std::array<glm::dvec3, 8> points{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t next = (i + 1) % polygon.size();
    const double here = distances.value[i], there = distances.value[next];
    if (std::abs(here) <= tolerance) {
      points[count++] = polygon[i];
    } else if (std::abs(there) > tolerance && (here > 0) != (there > 0)) {
      points[count++] = polygon[i] + here / (here - there) * (polygon[next] - polygon[i]);
    }
  }
  std::optional<Segment> longest;
  double most = 0;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      const double length = glm::distance(points[i], points[j]);
      if (length > most) {
        most = length;
        longest = Segment{points[i], points[j]};
      }
    }
  }
  return longest;
}

struct PairFinder {
  const Scene& scene;
  double tolerance;
  bool with_contacts;
  ContactPairs& found;

  void add_contact(PatchId touched, PatchId by, const Segment& segment, double gap = 0) const {
    const Patch& patch = scene.patch(touched);
    const auto inside = clip(segment, corners(patch.outline), patch.normal, tolerance);
    if (!inside) return;
    const double length = glm::distance(inside->from, inside->to);
    if (length > tolerance) found.contacts.push_back({touched, by, *inside, length, gap});
  }

  void add_outline(PatchId touched, PatchId by) const {
    const PolygonView outline = corners(scene.patch(by).outline);
    for (std::size_t i = 0; i < outline.size(); ++i) {
      add_contact(touched, by, {outline[i], outline[(i + 1) % outline.size()]});
    }
  }

  void add_coplanar(PatchId a, PatchId b) const {
    const Patch &first = scene.patch(a), &second = scene.patch(b);
    if (!share_area(corners(first.outline), corners(second.outline), first.normal, second.normal,
                    tolerance)) {
      return;
    }
    const bool one_sided = first.sides == kFront && second.sides == kFront;
    if (one_sided && glm::dot(first.normal, second.normal) < 0) {
      found.facing.push_back({a, b});
      if (with_contacts) {
        add_outline(a, b);
        add_outline(b, a);
      }
    } else {
      found.overlaps.push_back(overlap_of(a, b));
    }
  }

  /// Of one of them in front of the other, by the plane of the larger: that of a small one is known less well
  /// where it is far.
  static double height_over(const Patch& patch, const Patch& other) {
    const auto from_plane = [](const Patch& small, const Patch& large) {
      return Plane{large.outline.corner[0], large.normal}.distance(centroid(corners(small.outline)));
    };
    if (patch.area <= other.area) return from_plane(patch, other);
    const double sign = glm::dot(patch.normal, other.normal) > 0 ? -1 : 1;
    return sign * from_plane(other, patch);
  }

  [[nodiscard]] Overlap overlap_of(PatchId a, PatchId b) const {
    const bool b_is_first = scene.emits(b) && !scene.emits(a);
    Overlap overlap{b_is_first ? b : a, b_is_first ? a : b};
    const Patch &winner = scene.patch(overlap.winner), &loser = scene.patch(overlap.loser);
    const bool differ = winner.material != loser.material &&
                        (scene.emits(overlap.winner) || glm::dot(winner.normal, loser.normal) > 0);
    const double height = height_over(loser, winner);
    if (!differ || std::abs(height) <= kPlain * tolerance) return overlap;
    overlap.gap = std::abs(height);
    if (height > 0) std::swap(overlap.winner, overlap.loser);
    return overlap;
  }

  void add_pair(PatchId a, PatchId b) const {
    const Patch &first = scene.patch(a), &second = scene.patch(b);
    const PolygonView first_corners = corners(first.outline), second_corners = corners(second.outline);
    const Distances second_from_first(second_corners, first);
    if (second_from_first.apart(tolerance)) return;
    const Distances first_from_second(first_corners, second);
    if (first_from_second.apart(tolerance)) return;
    if (first_from_second.in_plane(tolerance) || second_from_first.in_plane(tolerance)) {
      // A needle no wider than the tolerance lies in every plane through it: it covers nothing.
      if (std::abs(glm::dot(first.normal, second.normal)) > 0.5) add_coplanar(a, b);
      return;
    }
    if (!with_contacts) return;
    if (const auto segment = section(second_corners, second_from_first, tolerance)) {
      add_contact(a, b, *segment);
    }
    if (const auto segment = section(first_corners, first_from_second, tolerance)) {
      add_contact(b, a, *segment);
    }
  }

  /// With all that have higher numbers, and what hovers. `near` is for use here.
  void add_pairs_of(const Entry& entry, const Tree& tree, std::vector<Entry>& near) const {
    const auto& [box, number] = entry;
    const Patch& patch = scene.patches[number];
    const double reach = kNarrowGap * width(corners(patch.outline), patch.normal);
    const bool hovers = with_contacts && reach > tolerance;
    near.clear();
    // The larger box holds the other one.
    tree.query(bg::index::intersects(hovers ? box_around(corners(patch.outline), reach) : box),
               std::back_inserter(near));
    for (const Entry& other : near) {
      if (other.second > number && bg::intersects(box, other.first))
        add_pair(PatchId{number}, PatchId{other.second});
    }
    if (!hovers) return;
    for (const Entry& other : near) {
      if (other.second != number) add_gap(PatchId{other.second}, PatchId{number}, reach);
    }
  }

  /// Edges of `over` no farther than `reach` from a used side of `under`, projected onto it.
  void add_gap(PatchId under, PatchId over, double reach) const {
    const Patch& patch = scene.patch(under);
    const PolygonView outline = corners(scene.patch(over).outline);
    const Distances distances(outline, patch);
    if (distances.apart(reach)) return;
    const auto project = [&](std::size_t i) { return outline[i] - distances.value[i] * patch.normal; };
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const std::size_t next = (i + 1) % outline.size();
      const double here = distances.value[i], there = distances.value[next];
      const std::uint32_t side = here > 0 ? kFront : kBack;
      const double gap = std::max(std::abs(here), std::abs(there));
      if ((here > 0) != (there > 0) || (patch.sides & side) == 0) continue;
      if (gap > reach || std::min(std::abs(here), std::abs(there)) <= tolerance) continue;
      add_contact(under, over, {project(i), project(next)}, gap);
    }
  }
};

}  // namespace

double contact_tolerance(const Scene& scene) {
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-low};
  for (const Patch& patch : scene.patches) {
    for (const glm::dvec3& x : corners(patch.outline)) {
      low = glm::min(low, x);
      high = glm::max(high, x);
    }
  }
  return scene.patches.empty() ? 0 : 1e-6 * glm::distance(low, high);
}

ContactPairs find_contact_pairs(const Scene& scene, double tolerance, bool with_contacts, int threads) {
  std::vector<Entry> entries;
  entries.reserve(scene.patches.size());
  for (const Patch& patch : scene.patches) {
    entries.emplace_back(box_around(corners(patch.outline), 0.5 * tolerance),
                         static_cast<std::uint32_t>(entries.size()));
  }
  const Tree tree(entries.begin(), entries.end());

  constexpr std::size_t kAtOnce = 1024;  // patches
  std::vector<ContactPairs> parts((entries.size() + kAtOnce - 1) / kAtOnce);
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
      const PairFinder finder{scene, tolerance, with_contacts, parts[part]};
      std::vector<Entry> near;
      const std::size_t first = part * kAtOnce;
      for (const Entry& entry : std::span(entries).subspan(first, std::min(kAtOnce, entries.size() - first)))
        finder.add_pairs_of(entry, tree, near);
    });
  });
  ContactPairs found;
  for (const ContactPairs& part : parts) {
    found.overlaps.insert(found.overlaps.end(), part.overlaps.begin(), part.overlaps.end());
    found.facing.insert(found.facing.end(), part.facing.begin(), part.facing.end());
    found.contacts.insert(found.contacts.end(), part.contacts.begin(), part.contacts.end());
  }
  // The tree's own order is not promised by its library.
  std::sort(found.overlaps.begin(), found.overlaps.end(), [&](const Overlap& a, const Overlap& b) {
    return std::tuple(!scene.emits(a.winner), a.winner, a.loser) <
           std::tuple(!scene.emits(b.winner), b.winner, b.loser);
  });
  std::ranges::sort(found.facing, {}, [](const Facing& of) { return std::pair(of.first, of.second); });
  // Equal lengths are equal in single precision too, whatever the unit has rounded them to in double.
  std::sort(found.contacts.begin(), found.contacts.end(), [](const Contact& a, const Contact& b) {
    const auto length = [](const Contact& contact) { return static_cast<float>(contact.length); };
    return std::tuple(a.touched, a.gap > 0, -length(a), a.by) <
           std::tuple(b.touched, b.gap > 0, -length(b), b.by);
  });
  return found;
}

}  // namespace fluxel
