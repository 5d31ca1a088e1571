#include "scene/receivers_off_surfaces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "scene/contact_pairs.hpp"
#include "scene/polygon.hpp"

namespace fluxel {

namespace {

/// Cosine between the normals of a meter and of what it lies on.
constexpr double kCosineOnSurface = 0.999;

/// A point of a receiver, by its first coordinate.
struct PlacedPoint {
  double x = 0;
  std::uint32_t receiver = 0, point = 0;
};

std::vector<PlacedPoint> points_by_x(const Scene& scene) {
  std::vector<PlacedPoint> all;
  for (std::uint32_t r = 0; r < scene.receivers.size(); ++r) {
    const Receiver& receiver = scene.receivers[r];
    for (std::uint32_t k = 0; k < receiver.points.size(); ++k) all.push_back({receiver.points[k].x, r, k});
  }
  std::ranges::stable_sort(all, {}, &PlacedPoint::x);
  return all;
}

glm::dvec3 middle_of(const Receiver& receiver) {
  glm::dvec3 sum(0);
  for (const glm::dvec3& point : receiver.points) sum += point / static_cast<double>(receiver.points.size());
  return sum;
}

/// The unit direction in which a point of the patch is moved away from it; 0: it stays.
glm::dvec3 way_off(const Patch& patch, const Receiver& receiver, const glm::dvec3& point) {
  const bool lies_on_it = receiver.quantity == Quantity::irradiance &&
                          std::abs(glm::dot(patch.normal, receiver.direction)) > kCosineOnSurface;
  if (lies_on_it || patch.sides == 0) return glm::dvec3(0);
  if (patch.sides == kFront) return patch.normal;
  if (patch.sides == kBack) return -patch.normal;
  const double to_others = glm::dot(middle_of(receiver) - point, patch.normal);
  const double to_middle = -glm::dot(point, patch.normal);  // of the scene
  return (to_others != 0 ? to_others : to_middle) < 0 ? -patch.normal : patch.normal;
}

}  // namespace

void move_receivers_off_surfaces(Scene& scene) {
  const std::vector<PlacedPoint> points = points_by_x(scene);
  if (points.empty()) return;
  const double tolerance = contact_tolerance(scene);
  const std::vector<Receiver> before = scene.receivers;
  std::vector<std::size_t> moved(scene.receivers.size());
  for (const Patch& patch : scene.patches) {
    const PolygonView outline = corners(patch.outline);
    const auto [low, high] = std::ranges::minmax(outline, {}, &glm::dvec3::x);
    auto near = std::ranges::lower_bound(points, low.x - tolerance, {}, &PlacedPoint::x);
    for (; near != points.end() && near->x <= high.x + tolerance; ++near) {
      const glm::dvec3& point = before[near->receiver].points[near->point];
      const double distance = Plane{outline[0], patch.normal}.distance(point);
      if (std::abs(distance) > tolerance ||
          squared_distance(point, outline, patch.normal) > tolerance * tolerance)
        continue;
      const glm::dvec3 way = way_off(patch, before[near->receiver], point);
      if (way == glm::dvec3(0)) continue;
      // Where two surfaces meet a point is moved off both, and once off faces of one plane.
      glm::dvec3& place = scene.receivers[near->receiver].points[near->point];
      const double wanting = 2 * tolerance - glm::dot(place - outline[0], way);
      if (wanting <= 0) continue;
      if (place == point) ++moved[near->receiver];
      place += wanting * way;
    }
  }
  for (std::size_t r = 0; r < moved.size(); ++r)
    if (moved[r] > 0)
      scene.notes.push_back(
          fmt::format("receiver '{}': {} of its {} points {} in a surface and {} moved off it by {:.2g} m",
                      scene.receivers[r].name, moved[r], scene.receivers[r].points.size(),
                      moved[r] == 1 ? "lies" : "lie", moved[r] == 1 ? "is" : "are", 2 * tolerance));
}

}  // namespace fluxel
