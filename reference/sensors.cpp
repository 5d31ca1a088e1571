#include "reference/sensors.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/sampling.hpp"
#include "scene/polygon.hpp"

namespace fluxel {

namespace {

class ElementSensors final : public Sensors {
 public:
  ElementSensors(const LightPaths& paths, const Scene& scene, std::span<const ElementShape> elements)
      : paths_(paths), scene_(scene), elements_(elements) {
    two_sided_ = std::ranges::any_of(elements, [&](const ElementShape& element) {
      return (scene.patch(element.patch).sides & kBack) != 0;
    });
  }

  [[nodiscard]] std::size_t size() const override { return (two_sided_ ? 2 : 1) * elements_.size(); }

  [[nodiscard]] double weight(std::size_t sensor) const override {
    return side(sensor).active ? area(corners(element(sensor).outline)) : 0;
  }

  [[nodiscard]] Rgb measure(std::size_t sensor, OwenSobol numbers, std::uint64_t& rays) const override {
    const ElementShape& element = this->element(sensor);
    const SideLight side = this->side(sensor);
    const auto [s, t, u, v] = numbers.next();
    const glm::dvec3& normal = scene_.patch(element.patch).normal;
    const LitPoint at{surface_point(element.outline, s, t), is_front(sensor) ? normal : -normal};
    return side.E + side.rho * paths_.irradiance(at, {u, v}, numbers, rays);
  }

 private:
  [[nodiscard]] bool is_front(std::size_t sensor) const { return sensor < elements_.size(); }
  [[nodiscard]] const ElementShape& element(std::size_t sensor) const {
    return elements_[sensor % elements_.size()];
  }
  [[nodiscard]] SideLight side(std::size_t sensor) const {
    return side_light(scene_, element(sensor).patch, is_front(sensor));
  }

  const LightPaths& paths_;
  const Scene& scene_;
  std::span<const ElementShape> elements_;
  bool two_sided_ = false;
};

class PixelSensors final : public Sensors {
 public:
  PixelSensors(const LightPaths& paths, const Scene& scene, const Camera& camera, int supersample)
      : paths_(paths), rays_(camera), eye_(camera.eye - scene.origin), supersample_(supersample) {}

  [[nodiscard]] std::size_t size() const override {
    return static_cast<std::size_t>(rays_.width()) * static_cast<std::size_t>(rays_.height());
  }
  [[nodiscard]] double weight(std::size_t /*sensor*/) const override { return 1; }

  [[nodiscard]] Rgb measure(std::size_t sensor, OwenSobol numbers, std::uint64_t& rays) const override {
    const auto width = static_cast<std::size_t>(rays_.width());
    const auto [s, t, u, v] = numbers.next();
    const std::size_t row = sensor / width;
    const double x = static_cast<double>(sensor % width) + placed(s);
    const double y = static_cast<double>(row) + placed(t);
    return paths_.radiance(eye_, rays_.towards(x, y), {u, v}, numbers, rays);
  }

 private:
  /// A place in the pixel.
  [[nodiscard]] double placed(double s) const {
    return supersample_ > 0 ? (std::floor(s * supersample_) + 0.5) / supersample_ : s;
  }

  const LightPaths& paths_;
  PixelRays rays_;
  glm::dvec3 eye_;
  int supersample_;
};

class CellSensors final : public Sensors {
 public:
  CellSensors(const LightPaths& paths, const Receiver& receiver)
      : paths_(paths), receiver_(receiver), normal_(glm::normalize(glm::cross(receiver.u, receiver.v))) {}

  [[nodiscard]] std::size_t size() const override {
    return static_cast<std::size_t>(receiver_.columns) * static_cast<std::size_t>(receiver_.rows);
  }
  [[nodiscard]] double weight(std::size_t /*sensor*/) const override { return 1; }

  [[nodiscard]] Rgb measure(std::size_t sensor, OwenSobol numbers, std::uint64_t& rays) const override {
    const auto columns = static_cast<std::size_t>(receiver_.columns);
    const auto [s, t, u, v] = numbers.next();
    const std::size_t row = sensor / columns;
    const double x = (static_cast<double>(sensor % columns) + s) / receiver_.columns;
    const double y = 1 - (static_cast<double>(row) + t) / receiver_.rows;
    return paths_.irradiance({receiver_.origin + x * receiver_.u + y * receiver_.v, normal_}, {u, v}, numbers,
                             rays);
  }

 private:
  const LightPaths& paths_;
  const Receiver& receiver_;
  glm::dvec3 normal_;
};

class PlaceSensors final : public Sensors {
 public:
  PlaceSensors(const LightPaths& paths, std::span<const SurfacePlace> places)
      : paths_(paths), places_(places) {}

  [[nodiscard]] std::size_t size() const override { return places_.size(); }
  [[nodiscard]] double weight(std::size_t /*sensor*/) const override { return 1; }

  [[nodiscard]] Rgb measure(std::size_t sensor, OwenSobol numbers, std::uint64_t& rays) const override {
    const SurfacePlace& place = places_[sensor];
    const auto light = numbers.next();
    return place.E + place.rho * paths_.irradiance(place.at, {light[0], light[1]}, numbers, rays);
  }

 private:
  const LightPaths& paths_;
  std::span<const SurfacePlace> places_;
};

}  // namespace

std::unique_ptr<Sensors> element_sensors(const LightPaths& paths, const Scene& scene,
                                         std::span<const ElementShape> elements) {
  return std::make_unique<ElementSensors>(paths, scene, elements);
}

std::unique_ptr<Sensors> pixel_sensors(const LightPaths& paths, const Scene& scene, const Camera& camera,
                                       int supersample) {
  return std::make_unique<PixelSensors>(paths, scene, camera, supersample);
}

std::unique_ptr<Sensors> cell_sensors(const LightPaths& paths, const Receiver& receiver) {
  return std::make_unique<CellSensors>(paths, receiver);
}

std::unique_ptr<Sensors> place_sensors(const LightPaths& paths, std::span<const SurfacePlace> places) {
  return std::make_unique<PlaceSensors>(paths, places);
}

}  // namespace fluxel
