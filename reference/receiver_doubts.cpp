#include "reference/receiver_doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>

#include "scene/scene.hpp"
#include "visibility/first_side.hpp"

namespace fluxel {

namespace {

constexpr int kDirections = 32;              // evenly over the sphere
constexpr std::size_t kMostCells = 1 << 14;  // of a receiver that are looked at

/// Evenly over the sphere along a spiral (Gonzalez 2010).
std::vector<glm::dvec3> directions() {
  std::vector<glm::dvec3> found;
  for (int k = 0; k < kDirections; ++k) {
    const double z = 1 - (2 * k + 1.0) / kDirections, radius = std::sqrt(1 - z * z);
    const double angle = 2 * std::numbers::pi * k / std::numbers::phi;
    found.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  return found;
}

/// The directions from which a receiver gets light.
std::vector<glm::dvec3> directions_of(const Receiver& receiver) {
  if (receiver.quantity == Quantity::radiance) return {receiver.direction};
  std::vector<glm::dvec3> found = directions();
  if (receiver.quantity != Quantity::irradiance) return found;
  const glm::dvec3 normal = receiver.is_grid() ? glm::cross(receiver.u, receiver.v) : receiver.direction;
  std::erase_if(found, [&](const glm::dvec3& direction) { return !(glm::dot(direction, normal) > 0); });
  return found;
}

}  // namespace

std::vector<std::string> receiver_doubts(const RayScene& ray_scene) {
  const Scene& scene = ray_scene.scene();
  const FirstSide first_side(ray_scene);
  std::vector<std::string> doubts;
  for (const Receiver& receiver : scene.receivers) {
    const std::vector<glm::dvec3> rays = directions_of(receiver);
    const std::size_t step = receiver.size() / kMostCells + 1;
    std::size_t looked_at = 0, dark = 0;
    std::map<PatchId, std::size_t> met;
    for (std::size_t cell = 0; cell < receiver.size(); cell += step) {
      if (!receiver.measures(cell)) continue;
      ++looked_at;
      MetSide last;
      const bool sees_nothing = std::ranges::all_of(rays, [&](const glm::dvec3& direction) {
        last = first_side.meet(receiver.place(cell, 0.5, 0.5), direction);
        return last.patch != kNoPatch && !last.active;
      });
      if (!sees_nothing) continue;
      ++dark;
      ++met[last.patch];
    }
    if (dark == 0) continue;
    const auto most = std::ranges::max_element(met, {}, [](const auto& of) { return of.second; });
    doubts.push_back(fmt::format(
        "receiver '{}': {:.3g} % of its {} see nothing but dark backs, as that of '{}': they lie inside "
        "or behind a surface, and have no light",
        receiver.name, 100.0 * static_cast<double>(dark) / static_cast<double>(looked_at),
        receiver.is_grid() ? "cells" : "points", scene.groups[index(scene.patch(most->first).group)]));
  }
  return doubts;
}

}  // namespace fluxel
