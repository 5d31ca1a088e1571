#include "method/glare.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/luminance.hpp"
#include "core/sampling.hpp"
#include "formfactor/free_segments.hpp"
#include "method/measure_sensors.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "optics/emitters.hpp"
#include "optics/luminaire_intensity.hpp"
#include "reference/receiver_sensors.hpp"

namespace fluxel {

namespace {

/// Points of a source along each of its edges: of a large one, and of one that is small for its distance.
constexpr int kPointsOfSource = 16, kPointsOfSmall = 4;
constexpr double kSmall = 0.1;  // extent over distance

/// Of small sources: the projected area that they count for (CIE 147:2002) [m2].
constexpr double kLeastArea = 0.005;

/// Cosine of an opening's direction at least: tables hold light that leaves the edge of a luminaire, which a
/// flat opening has none of.
constexpr double kLeastCosine = 0.0175;  // a degree

/// The field of view (CIE 117:1995, table 4.1), over the distance ahead: up (H/R) and aside (T/R).
constexpr double kMostAbove = 1.9, kMostAside = 3;

/// A point of a source, seen from the eye.
struct SourcePoint {
  glm::dvec3 position{0}, normal{0};
  double luminance = 0;
  double area = 0;  ///< projected [m2]
};

/// What one observer sees.
class Eye {
 public:
  Eye(const RayScene& ray_scene, const Observer& observer) : ray_scene_(ray_scene), observer_(observer) {}

  /// Adds a source's points, those that are seen.
  void add_source(std::span<const SourcePoint> points) {
    double solid_angle = 0;
    std::array<SurfaceSegment, RayPacket::kSize> segments;
    std::array<const SourcePoint*, RayPacket::kSize> waiting;
    std::size_t count = 0;
    const auto trace = [&] {
      const std::uint32_t free = free_segments(ray_scene_, std::span(segments).first(count));
      for (std::size_t k = 0; k < count; ++k)
        if ((free >> k & 1u) != 0) solid_angle += add(*waiting[k]);
      count = 0;
    };
    for (const SourcePoint& point : points) {
      const glm::dvec3 way = point.position - observer_.eye;
      if (!(point.luminance > 0) || !is_in_field(way)) continue;
      // The eye is no surface: its end of the segment is lifted towards the source.
      segments[count] = {observer_.eye, glm::normalize(way), point.position, point.normal};
      waiting[count++] = &point;
      if (count == segments.size()) trace();
    }
    if (count > 0) trace();
    seen_.solid_angle += solid_angle;
    seen_.largest = std::max(seen_.largest, solid_angle);
  }

  [[nodiscard]] const GlareSources& seen() const { return seen_; }

 private:
  /// Whether it is above the line of sight and neither too far aside nor hidden by the brow.
  [[nodiscard]] bool is_in_field(const glm::dvec3& way) const {
    const double ahead = glm::dot(way, observer_.direction), above = glm::dot(way, observer_.up);
    const double aside = std::abs(glm::dot(way, glm::cross(observer_.direction, observer_.up)));
    return above > 0 && above < kMostAbove * ahead && aside < kMostAside * ahead;
  }

  /// Returns its solid angle.
  double add(const SourcePoint& point) {
    const glm::dvec3 way = point.position - observer_.eye;
    const double squared = glm::dot(way, way), solid_angle = point.area / squared;
    const double cosine = glm::dot(way, observer_.direction) / std::sqrt(squared);
    const glm::dvec3 aside = glm::cross(observer_.direction, observer_.up);
    const double p = position_index(std::acos(std::min(cosine, 1.0)),
                                    std::atan2(std::abs(glm::dot(way, aside)), glm::dot(way, observer_.up)));
    seen_.weighted += point.luminance * point.luminance * solid_angle / (p * p);
    return solid_angle;
  }

  const RayScene& ray_scene_;
  const Observer& observer_;
  GlareSources seen_;
};

/// Calls `add(u, v)` with the middles of equal parts of the unit square, `side` along each of its sides.
void for_each_part(int side, const std::function<void(double, double)>& add) {
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) add((i + 0.5) / side, (j + 0.5) / side);
}

int points_along(double extent, double distance) {
  return extent > kSmall * distance ? kPointsOfSource : kPointsOfSmall;
}

std::vector<SourcePoint> points_of(const Luminaire& of, const IntensityTable& table, const glm::dvec3& eye) {
  const double area = of.size.x * of.size.y * (of.round ? std::numbers::pi / 4 : 1);
  const glm::dvec3 across = glm::cross(of.ahead, of.aim);
  const int side = area > 0 ? points_along(glm::length(of.size), glm::length(eye - of.position)) : 1;
  const double share = 1.0 / (side * side);
  std::vector<SourcePoint> points;
  for_each_part(side, [&](double u, double v) {
    SourcePoint point{opening_point(of, u, v), {}, 0, 0};
    const glm::dvec3 way = eye - point.position;
    const double distance = glm::length(way);
    if (!(distance > 0)) return;
    const double cosine = glm::dot(way, of.aim) / distance;
    point.normal = cosine < 0 ? -of.aim : of.aim;
    const double projected = std::max(area * std::max(std::abs(cosine), kLeastCosine), kLeastArea);
    point.luminance = luminance(of.scale) * intensity_along(way, distance, of, across, table) / projected;
    point.area = share * projected;
    points.push_back(point);
  });
  return points;
}

std::vector<SourcePoint> points_of(const EmittingSide& of, const glm::dvec3& eye) {
  const double whole = area(corners(of.outline));
  const int side = points_along(std::sqrt(whole), glm::length(eye - centroid(corners(of.outline))));
  const double share = whole / (side * side);
  std::vector<SourcePoint> points;
  for_each_part(side, [&](double u, double v) {
    const glm::dvec3 position = surface_point(of.outline, u, v), way = eye - position;
    const double in = glm::dot(way, of.normal);
    if (in > 0)
      points.push_back(
          {position, of.normal, luminance(of.E) / std::numbers::pi, share * in / glm::length(way)});
  });
  return points;
}

GlareSources seen_by(const Observer& observer, const RayScene& ray_scene, const Emitters& emitters) {
  Eye eye(ray_scene, observer);
  const Scene& scene = ray_scene.scene();
  for (const Luminaire& luminaire : scene.luminaires)
    eye.add_source(points_of(luminaire, scene.intensity(luminaire), observer.eye));
  for (const EmittingSide& side : emitters.sides()) eye.add_source(points_of(side, observer.eye));
  return eye.seen();
}

}  // namespace

void rate_glare(const Problem& problem, const LightPaths& paths, const PathGoal& goal, Solution& solution) {
  const std::span<const Observer> observers = problem.sensors.observers;
  if (observers.empty() || solution.stopped) return;
  // What is asked of other sensors alone, or in their unit, is not asked of eyes.
  PathGoal of_eyes = goal;
  if (!goal.limits.error.of.empty() || goal.limits.error.absolute_error) {
    of_eyes.limits.error = {};
    of_eyes.is_asked_for = false;
  }
  const SensorLight eyes =
      measure_sensors(problem, Measured::receivers, "observers' eyes", *observer_sensors(paths, observers),
                      static_cast<int>(observers.size()), of_eyes);
  solution.goal_reached = solution.goal_reached && eyes.measured.reached;
  solution.stopped = solution.stopped || eyes.measured.stopped;
  on_root(problem.world, [&] {
    const Emitters emitters(problem.scene);
    for (std::size_t k = 0; k < observers.size(); ++k) {
      const SensorEstimate& eye = eyes.measured.sensors[k];
      solution.glare.push_back({observers[k].name, seen_by(observers[k], problem.ray_scene, emitters),
                                luminance(eye.mean), luminance(eye.error), eyes.measured.reached});
    }
  });
}

}  // namespace fluxel
