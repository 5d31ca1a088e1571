#include "scene/coplanar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>
#include <string>
#include <utility>

namespace fluxel {
namespace {

constexpr std::size_t kMaxNotes = 10;

struct GroupOverlap {
  std::size_t pairs = 0;
  double area = 0;  ///< [m2]
};

struct GroupLoss {
  std::size_t patches = 0;
  PatchId first = kNoPatch;
};

void add_capped(std::vector<std::string>& notes, const std::vector<std::string>& more, const char* what) {
  const std::size_t shown = std::min(more.size(), kMaxNotes);
  notes.insert(notes.end(), more.begin(), more.begin() + static_cast<std::ptrdiff_t>(shown));
  if (more.size() > shown) notes.push_back(fmt::format("... and {} more {}", more.size() - shown, what));
}

const std::string& group_name(const Scene& scene, PatchId patch) {
  return scene.groups[index(scene.patch(patch).group)];
}

/// Rays that leave a clear body where another surface lies in its plane have passed that surface, too.
void note_clear_contacts(Scene& scene, std::span<const Overlap> overlaps) {
  const auto is_clear = [&](PatchId patch) {
    return scene.material(scene.patch(patch)).optics.bounds_clear_body();
  };
  const auto touches = [&](const Overlap& of) { return is_clear(of.winner) || is_clear(of.loser); };
  const auto first = std::ranges::find_if(overlaps, touches);
  if (first == overlaps.end()) return;
  scene.notes.push_back(
      fmt::format("{} faces of clear bodies lie on other surfaces, the first between '{}' and '{}': light is "
                  "not followed "
                  "right there; leave a gap of a hundred-thousandth of the scene's size between them",
                  std::ranges::count_if(overlaps, touches), group_name(scene, first->winner),
                  group_name(scene, first->loser)));
}

/// What remains of polygons after others of the same plane, of a patch of that normal, are taken from them.
std::vector<Polygon> without(std::vector<Polygon> polygons, const std::vector<Polygon>& cutters,
                             const glm::dvec3& normal, double tolerance, double& covered) {
  for (const Polygon& cutter : cutters) {
    std::vector<Polygon> remaining;
    for (const Polygon& polygon : polygons) {
      auto parts = difference(polygon, cutter, normal, tolerance, covered);
      std::move(parts.begin(), parts.end(), std::back_inserter(remaining));
    }
    polygons = std::move(remaining);
  }
  return polygons;
}

/// Of the largest gap between each pair of groups.
void warn_of_gaps(Scene& scene, std::span<const Overlap> overlaps) {
  std::map<std::pair<std::string, std::string>, double> gaps;
  for (const Overlap& overlap : overlaps) {
    if (overlap.gap == 0) continue;
    double& gap = gaps[{group_name(scene, overlap.winner), group_name(scene, overlap.loser)}];
    gap = std::max(gap, overlap.gap);
  }
  std::vector<std::string> warnings;
  warnings.reserve(gaps.size());
  for (const auto& [groups, gap] : gaps)
    warnings.push_back(fmt::format(
        "'{}' lies {:.2g} m from '{}': so little beside the scene's size that they count as one plane, "
        "in which '{}' is covered; move them apart, or make the scene smaller",
        groups.first, gap, groups.second, groups.second));
  add_capped(scene.warnings, warnings, "pairs of groups that hardly lie apart");
}

}  // namespace

void take_touching_areas(Scene& scene, std::span<const Facing> facing, const std::vector<bool>& of_bodies,
                         double tolerance, std::vector<std::vector<Polygon>>& polygons) {
  std::map<std::pair<std::string, std::string>, double> by_groups;
  for (const auto& [first, second] : facing) {
    if (!of_bodies[index(first)] && !of_bodies[index(second)]) continue;
    std::vector<Polygon>& of_first = polygons[index(first)];
    std::vector<Polygon>& of_second = polygons[index(second)];
    double touching = 0, same = 0;
    std::vector<Polygon> left = without(of_first, of_second, scene.patch(second).normal, tolerance, touching);
    of_second = without(std::move(of_second), of_first, scene.patch(first).normal, tolerance, same);
    of_first = std::move(left);
    if (touching > 0) by_groups[{group_name(scene, first), group_name(scene, second)}] += touching;
  }
  std::vector<std::string> notes;
  notes.reserve(by_groups.size());
  for (const auto& [groups, area] : by_groups)
    notes.push_back(
        fmt::format("'{}' and '{}' touch over {:.6g} m2, where neither sees anything and both are "
                    "left out",
                    groups.first, groups.second, area));
  add_capped(scene.notes, notes, "pairs of groups that touch");
}

void take_covered_areas(Scene& scene, std::span<const Overlap> overlaps, double tolerance,
                        std::vector<std::vector<Polygon>>& polygons) {
  std::map<std::pair<std::string, std::string>, GroupOverlap> by_groups;
  note_clear_contacts(scene, overlaps);
  warn_of_gaps(scene, overlaps);
  for (const Overlap& overlap : overlaps)
    if (overlap.gap > 0 && scene.emits(overlap.loser))
      scene.patches[index(overlap.winner)].covers_emitter = true;
  for (const Overlap& overlap : overlaps) {
    double covered = 0;
    // What has been taken from the winner itself covers nothing more: its own winner does, where it may.
    std::vector<Polygon>& of_loser = polygons[index(overlap.loser)];
    of_loser = without(std::move(of_loser), polygons[index(overlap.winner)],
                       scene.patch(overlap.winner).normal, tolerance, covered);
    GroupOverlap& sum = by_groups[{group_name(scene, overlap.winner), group_name(scene, overlap.loser)}];
    ++sum.pairs;
    sum.area += covered;
    scene.statistics.covered_area += covered;
  }
  scene.statistics.coplanar_overlaps += overlaps.size();

  // The largest first, for the notes are capped.
  std::vector<std::pair<std::pair<std::string, std::string>, GroupOverlap>> sorted(by_groups.begin(),
                                                                                   by_groups.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second.area > b.second.area; });
  std::vector<std::string> notes;
  for (const auto& [groups, sum] : sorted) {
    const std::string pairs = fmt::format("{} {} of patches", sum.pairs, sum.pairs == 1 ? "pair" : "pairs");
    notes.push_back(
        groups.first == groups.second
            ? fmt::format("patches of '{}' cover {:.6g} m2 of one another in one plane, counted once ({})",
                          groups.first, sum.area, pairs)
            : fmt::format("'{}' lies in the plane of '{}' and covers {:.6g} m2 of it, taken from '{}' ({})",
                          groups.first, groups.second, sum.area, groups.second, pairs));
  }
  add_capped(scene.notes, notes, "pairs of groups that overlap in one plane");

  std::map<std::string, GroupLoss> lost;
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    if (!polygons[i].empty()) continue;
    const PatchId patch{static_cast<std::uint32_t>(i)};
    GroupLoss& loss = lost[group_name(scene, patch)];
    if (loss.patches++ == 0) loss.first = patch;
  }
  notes.clear();
  for (const auto& [group, loss] : lost) {
    notes.push_back(
        fmt::format("{} of '{}' {} wholly covered by others of its plane (duplicates?) and left out: the "
                    "first is patch {}",
                    loss.patches == 1 ? "a patch" : fmt::format("{} patches", loss.patches), group,
                    loss.patches == 1 ? "is" : "are", index(loss.first)));
  }
  add_capped(scene.notes, notes, "groups with wholly covered patches");
}

}  // namespace fluxel
