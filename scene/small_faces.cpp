#include "scene/small_faces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "scene/list_names.hpp"

namespace fluxel {
namespace {

/// The group that reaches farthest from the middle of the scene.
GroupId farthest_group(const SceneInput& input, const glm::dvec3& middle) {
  double farthest = -1;
  GroupId group{};
  for (const InputPolygon& polygon : input.polygons) {
    for (const glm::dvec3& corner : polygon.corners) {
      const glm::dvec3 x = corner - middle;
      const double distance = std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)});
      if (distance > farthest) std::tie(farthest, group) = std::pair(distance, polygon.group);
    }
  }
  return group;
}

}  // namespace

void SmallFaces::add(GroupId group, bool emits) {
  Count& count = groups_[group];
  ++count.faces;
  if (emits) ++count.emitting;
}

void SmallFaces::report(const SceneInput& input, double diagonal, double least_area, Scene& scene) const {
  if (groups_.empty()) return;
  Count all;
  std::vector<std::string> emitting, others;
  for (const auto& [group, count] : groups_) {
    all.faces += count.faces;
    all.emitting += count.emitting;
    (count.emitting > 0 ? emitting : others)
        .push_back(fmt::format("'{}' ({}{})", input.groups[index(group)], count.faces,
                               count.emitting == 0 ? ""
                               : count.emitting == count.faces
                                   ? ", emitting"
                                   : fmt::format(", {} emitting", count.emitting)));
  }
  emitting.insert(emitting.end(), others.begin(), others.end());
  std::string sentence = fmt::format(
      "{} {} too small for this scene and dropped, {} of them emitting, of group {}: below {:.3g} m2, a "
      "square "
      "of {:.3g} m, which is 1e-7 of the {:.3g} m that the scene is across; leave out or bring nearer what "
      "is "
      "far away (group '{}' reaches farthest); {}",
      all.faces, all.faces == 1 ? "face is" : "faces are", all.emitting, list_names(emitting), least_area,
      std::sqrt(least_area), diagonal, input.groups[index(farthest_group(input, scene.origin))],
      ask_for_unit(input));
  if (all.emitting > 0) scene.lost_emitters = sentence;
  scene.notes.push_back(std::move(sentence));
}

std::string ask_for_unit(const SceneInput& input) {
  std::vector<std::string> units;
  for (const InputGeometry& geometry : input.geometry) {
    if (geometry.metres_per_unit != 1)
      units.push_back(fmt::format("{} for {}", geometry.metres_per_unit, geometry.file.string()));
  }
  return "is metres_per_unit right?" + (units.empty() ? "" : " It is " + list_names(units));
}

}  // namespace fluxel
