#include "scene/merge_region.hpp"

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <tuple>
#include <unordered_map>

#include "scene/simple_outline.hpp"

namespace fluxel {
namespace {

/// The sine below which two directions are one: rows only have to be told from columns.
constexpr double kParallel = 1e-3;

std::uint32_t corner(const MergedPart& part, std::size_t i) {
  return part.outline.corner[i % part.outline.corners];
}

/// The first corner is the first of `model` that stays one, so that halves of a parallelogram give it back.
void begin_as(Outline<std::uint32_t>& outline, const Outline<std::uint32_t>& model) {
  const auto end = outline.corner.begin() + outline.corners;
  for (std::size_t i = 0; i < model.corners; ++i) {
    const auto found = std::find(outline.corner.begin(), end, model.corner[i]);
    if (found == end) continue;
    std::rotate(outline.corner.begin(), found, end);
    return;
  }
}

class RegionMerger {
 public:
  RegionMerger(std::span<const MergedPart> patches, std::span<const glm::dvec3> places,
               const MergeTolerance& tolerance)
      : parts_(patches.begin(), patches.end()), places_(places), tolerance_(tolerance) {
    part_at_.reserve(4 * parts_.size());
  }

  std::vector<MergedPart> merge() {
    for (std::uint32_t part = 0; part < parts_.size(); ++part) {
      // Two patches that run along an edge in one direction lie on one another.
      if (!add_edges(part)) return parts_;
    }
    if (const auto whole = merged_whole()) return {*whole};
    while (pair_triangles() + join_rows() > 0) {
    }
    std::erase_if(parts_, [](const MergedPart& part) { return part.outline.corners == 0; });
    return parts_;
  }

 private:
  static std::uint64_t key(std::uint32_t from, std::uint32_t to) { return std::uint64_t{from} << 32 | to; }

  bool add_edges(std::uint32_t part) {
    const MergedPart& added = parts_[part];
    for (std::size_t i = 0; i < added.outline.corners; ++i) {
      if (!part_at_.emplace(key(corner(added, i), corner(added, i + 1)), part).second) return false;
    }
    return true;
  }

  void remove(std::uint32_t part) {
    MergedPart& removed = parts_[part];
    for (std::size_t i = 0; i < removed.outline.corners; ++i)
      part_at_.erase(key(corner(removed, i), corner(removed, i + 1)));
    removed.outline.corners = 0;
  }

  /// The part beyond an edge that it has from end to end.
  [[nodiscard]] std::optional<std::uint32_t> beyond(const MergedPart& part, std::size_t edge) const {
    const auto found = part_at_.find(key(corner(part, edge + 1), corner(part, edge)));
    return found == part_at_.end() ? std::nullopt : std::optional(found->second);
  }

  /// All as one, where their boundary is one closed line and a simple outline.
  [[nodiscard]] std::optional<MergedPart> merged_whole() const {
    std::unordered_map<std::uint32_t, std::uint32_t> next;
    std::uint32_t begin = 0;
    MergedPart whole = parts_.front();
    whole.patches = parts_.size();
    for (const MergedPart& part : parts_) {
      for (std::size_t i = 0; i < part.outline.corners; ++i) {
        if (beyond(part, i)) continue;
        begin = corner(part, i);
        if (!next.emplace(begin, corner(part, i + 1)).second) return std::nullopt;
      }
    }
    std::vector<std::uint32_t> loop;
    if (next.empty()) return std::nullopt;
    for (std::uint32_t place = begin; loop.empty() || place != begin; place = next.at(place))
      loop.push_back(place);
    if (loop.size() < next.size()) return std::nullopt;
    const auto simple = simple_outline(loop, places_, 0, tolerance_);
    if (!simple) return std::nullopt;
    const Outline<std::uint32_t> model = whole.outline;
    whole.outline = simple->outline;
    begin_as(whole.outline, model);
    return whole;
  }

  /// The two parts of an edge as one, where they make a polygon of that many corners.
  [[nodiscard]] std::optional<MergedPart> joined(const MergedPart& a, std::size_t edge, const MergedPart& b,
                                                 std::uint32_t wanted) const {
    std::size_t there = 0;
    while (corner(b, there) != corner(a, edge + 1)) ++there;
    boost::container::static_vector<std::uint32_t, 6> loop;
    for (std::size_t i = 1; i <= a.outline.corners; ++i) loop.push_back(corner(a, edge + i));
    for (std::size_t i = 2; i < b.outline.corners; ++i) loop.push_back(corner(b, there + i));
    MergedPart sum = a.lowest < b.lowest ? a : b;
    const Outline<std::uint32_t> model = sum.outline;
    sum.patches = a.patches + b.patches;
    const auto simple =
        simple_outline({loop.data(), loop.size()}, places_, std::max(a.deviation, b.deviation), tolerance_);
    if (!simple || simple->outline.corners != wanted) return std::nullopt;
    sum.outline = simple->outline;
    sum.deviation = simple->deviation;
    begin_as(sum.outline, model);
    return sum;
  }

  /// Joins the two parts of an edge, where that is possible. The sum stands where the lower one stood: there.
  std::optional<std::uint32_t> join(std::uint32_t part, std::size_t edge, std::uint32_t other,
                                    std::uint32_t wanted) {
    const auto sum = joined(parts_[part], edge, parts_[other], wanted);
    if (!sum) return std::nullopt;
    remove(part);
    remove(other);
    const std::uint32_t kept = std::min(part, other);
    parts_[kept] = *sum;
    add_edges(kept);
    return kept;
  }

  [[nodiscard]] glm::dvec3 along(const MergedPart& part, std::size_t edge) const {
    return places_[corner(part, edge + 1)] - places_[corner(part, edge)];
  }

  std::size_t pair_triangles() {
    struct Candidate {
      double length;
      std::uint32_t low, high;
      std::size_t edge;  // of the lower part
    };
    std::vector<Candidate> candidates;
    for (std::uint32_t part = 0; part < parts_.size(); ++part) {
      if (parts_[part].outline.corners != 3) continue;
      for (std::size_t edge = 0; edge < 3; ++edge) {
        const auto other = beyond(parts_[part], edge);
        if (other && *other > part && parts_[*other].outline.corners == 3)
          candidates.push_back({glm::length(along(parts_[part], edge)), part, *other, edge});
      }
    }
    std::ranges::sort(candidates, {},
                      [](const Candidate& c) { return std::tuple(-c.length, c.low, c.high); });
    std::size_t joins = 0;
    for (const Candidate& c : candidates) {
      if (parts_[c.low].outline.corners == 3 && parts_[c.high].outline.corners == 3 &&
          join(c.low, c.edge, c.high, 4))
        ++joins;
    }
    return joins;
  }

  /// Over the edges of one direction first, so that rows are whole before they are joined.
  std::size_t join_rows() {
    const auto first = std::ranges::find(parts_, 4u, [](const MergedPart& p) { return p.outline.corners; });
    std::size_t joins = 0;
    if (first != parts_.end()) {
      const std::size_t longer = glm::length(along(*first, 0)) >= glm::length(along(*first, 1)) ? 0 : 1;
      const glm::dvec3 direction = glm::normalize(along(*first, longer));
      const auto parallel = [&](const glm::dvec3& edge) {
        return glm::length(glm::cross(edge, direction)) <= kParallel * glm::length(edge);
      };
      joins += grow(4, parallel);
      joins += grow(4, [&](const glm::dvec3& edge) { return !parallel(edge); });
    }
    return joins + grow(3, [](const glm::dvec3&) { return true; });
  }

  /// Lets each polygon of that many corners take in its like over the edges that are `wanted`.
  template <class Wanted>
  std::size_t grow(std::uint32_t corners, const Wanted& wanted) {
    std::size_t joins = 0;
    for (std::uint32_t seed = 0; seed < parts_.size(); ++seed) {
      std::uint32_t part = seed;
      for (std::size_t edge = 0; edge < corners && parts_[part].outline.corners == corners;) {
        const auto other = beyond(parts_[part], edge);
        const bool fits =
            other && parts_[*other].outline.corners == corners && wanted(along(parts_[part], edge));
        const auto sum = fits ? join(part, edge, *other, corners) : std::nullopt;
        if (sum) {
          ++joins;
          part = *sum;
          edge = 0;
        } else {
          ++edge;
        }
      }
    }
    return joins;
  }

  std::vector<MergedPart> parts_;                             // without corners: taken in by another
  std::unordered_map<std::uint64_t, std::uint32_t> part_at_;  // the part on the left of each edge
  std::span<const glm::dvec3> places_;
  const MergeTolerance& tolerance_;
};

}  // namespace

std::vector<MergedPart> merge_region(std::span<const MergedPart> patches, std::span<const glm::dvec3> places,
                                     const MergeTolerance& tolerance) {
  return RegionMerger(patches, places, tolerance).merge();
}

}  // namespace fluxel
