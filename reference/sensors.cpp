#include "reference/sensors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "core/sampling.hpp"
#include "reference/leaving_side.hpp"
#include "reference/onward_ways.hpp"
#include "reference/sensor_starts.hpp"
#include "scene/polygon.hpp"

namespace fluxel {

namespace {

class ElementSensors final : public SurfaceSensors {
 public:
  ElementSensors(const LightPaths& paths, const Scene& scene, std::span<const ElementShape> elements)
      : SurfaceSensors(paths), scene_(scene), elements_(elements) {
    two_sided_ = std::ranges::any_of(elements, [&](const ElementShape& element) {
      return (scene.patch(element.patch).sides & kBack) != 0;
    });
  }

  [[nodiscard]] std::size_t size() const override { return (two_sided_ ? 2 : 1) * elements_.size(); }

  [[nodiscard]] double weight(std::size_t sensor) const override {
    return side_light(scene_, element(sensor).patch, is_front(sensor)).active
               ? area(corners(element(sensor).outline))
               : 0;
  }

 private:
  [[nodiscard]] SensorStart start_at(std::size_t sensor, const std::array<double, 4>& even,
                                     OwenSobol& numbers) const override {
    const ElementShape& element = this->element(sensor);
    const auto [s, t, u, v] = even;
    const glm::dvec3& normal = scene_.patch(element.patch).normal;
    const SideLight side = leaving_side(scene_, element.patch, is_front(sensor));
    const ElementSide on = chosen_side(side, numbers);
    const bool front = is_front(sensor) == on.is_own;
    return {{{surface_point(element.outline, s, t), front ? normal : -normal}, {u, v}, numbers},
            side.E,
            on.share};
  }

  /// The side whose irradiance a path finds, and what its share of the radiosity is over the side's chance.
  struct ElementSide {
    bool is_own = true;
    Rgb share{0};
  };
  /// Each as often as its share says.
  [[nodiscard]] static ElementSide chosen_side(const SideLight& side, OwenSobol& numbers) {
    const Rgb& through = side.optics.diffuse_transmission;
    if (through == Rgb(0)) return {true, side.rho};
    const double of_own = largest_colour(side.rho), of_other = largest_colour(through);
    const double chance = of_own / (of_own + of_other);
    if (numbers.next_random() < chance) return {true, side.rho / chance};
    return {false, through / (1 - chance)};
  }
  [[nodiscard]] bool is_front(std::size_t sensor) const { return sensor < elements_.size(); }
  [[nodiscard]] const ElementShape& element(std::size_t sensor) const {
    return elements_[sensor % elements_.size()];
  }

  const Scene& scene_;
  std::span<const ElementShape> elements_;
  bool two_sided_ = false;
};

class PixelSensors final : public SightSensors {
 public:
  PixelSensors(const LightPaths& paths, const Scene& scene, const Camera& camera, int supersample)
      : SightSensors(paths), rays_(camera), eye_(camera.eye - scene.origin), supersample_(supersample) {}

  [[nodiscard]] std::size_t size() const override {
    return static_cast<std::size_t>(rays_.width()) * static_cast<std::size_t>(rays_.height());
  }
  [[nodiscard]] double weight(std::size_t /*sensor*/) const override { return 1; }

 private:
  /// Through a place in the pixel.
  [[nodiscard]] Ray sight(std::size_t pixel, double s, double t, OwenSobol& /*numbers*/) const override {
    const auto width = static_cast<std::size_t>(rays_.width());
    const std::size_t row = pixel / width;
    return {eye_, rays_.towards(static_cast<double>(pixel % width) + placed(s),
                                static_cast<double>(row) + placed(t))};
  }
  [[nodiscard]] double placed(double s) const {
    return supersample_ > 0 ? (std::floor(s * supersample_) + 0.5) / supersample_ : s;
  }

  PixelRays rays_;
  glm::dvec3 eye_;
  int supersample_;
};

class PlaceSensors final : public SurfaceSensors {
 public:
  PlaceSensors(const LightPaths& paths, std::span<const SurfacePlace> places)
      : SurfaceSensors(paths), places_(places) {}

  [[nodiscard]] std::size_t size() const override { return places_.size(); }
  [[nodiscard]] double weight(std::size_t /*sensor*/) const override { return 1; }

 private:
  [[nodiscard]] SensorStart start_at(std::size_t sensor, const std::array<double, 4>& even,
                                     OwenSobol& numbers) const override {
    const SurfacePlace& place = places_[sensor];
    return {{place.at, {even[0], even[1]}, numbers}, place.E, place.rho};
  }

  std::span<const SurfacePlace> places_;
};

}  // namespace

void PathSensors::measure(std::span<const SensorPath> paths, std::span<Rgb> found,
                          std::uint64_t& rays) const {
  std::vector<SensorStart> started;
  started.reserve(paths.size());
  start(paths, started, rays);
  std::vector<PathStart> starts;
  starts.reserve(started.size());
  for (const SensorStart& one : started) starts.push_back(one.path);
  std::vector<Rgb> irradiance(started.size());
  paths_.irradiance(starts, irradiance, rays);
  std::ranges::fill(found, Rgb(0));
  for (std::size_t k = 0; k < started.size(); ++k) found[started[k].number] = started[k].value(irradiance[k]);
}

std::unique_ptr<PathSensors> element_sensors(const LightPaths& paths, const Scene& scene,
                                             std::span<const ElementShape> elements) {
  return std::make_unique<ElementSensors>(paths, scene, elements);
}

std::unique_ptr<PathSensors> pixel_sensors(const LightPaths& paths, const Scene& scene, const Camera& camera,
                                           int supersample) {
  return std::make_unique<PixelSensors>(paths, scene, camera, supersample);
}

std::unique_ptr<PathSensors> place_sensors(const LightPaths& paths, std::span<const SurfacePlace> places) {
  return std::make_unique<PlaceSensors>(paths, places);
}

}  // namespace fluxel
