#include "scene/most_crossed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "scene/polygon.hpp"

namespace fluxel {
namespace {

/// How often a group is crossed, and its patch that is crossed most often.
struct CrossedGroup {
  std::size_t times = 0;
  std::size_t most_times = 0;
  PatchId most{};
  std::size_t group = 0;
};

}  // namespace

std::string most_crossed(const Scene& scene, const std::vector<Contact>& contacts) {
  std::vector<std::size_t> times(scene.patches.size());
  for (const Contact& contact : contacts)
    if (contact.gap == 0) ++times[index(contact.touched)];
  std::vector<CrossedGroup> groups(scene.groups.size());
  for (std::size_t i = 0; i < groups.size(); ++i) groups[i].group = i;
  for (std::size_t i = 0; i < times.size(); ++i) {
    CrossedGroup& group = groups[index(scene.patches[i].group)];
    group.times += times[i];
    if (times[i] <= group.most_times) continue;
    group.most_times = times[i];
    group.most = PatchId{static_cast<std::uint32_t>(i)};
  }
  std::ranges::stable_sort(groups, std::ranges::greater{}, &CrossedGroup::times);

  constexpr std::size_t kShown = 3;
  std::string text;
  for (std::size_t k = 0; k < std::min(kShown, groups.size()) && groups[k].times > 0; ++k) {
    const CrossedGroup& group = groups[k];
    const glm::dvec3 at = centroid(corners(scene.patch(group.most).outline)) + scene.origin;
    text += fmt::format("{} '{}' {} times, {} of them the patch around {:.4g},{:.4g},{:.4g} m",
                        k == 0 ? "crossed most are group" : ", group", scene.groups[group.group], group.times,
                        group.most_times, at.x, at.y, at.z);
  }
  return text;
}

}  // namespace fluxel
