#include "reference/receiver_sensors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "reference/sensor_starts.hpp"

namespace fluxel {

namespace {

/// Uniform over the solid angle, from the unit square.
glm::dvec3 uniform_in_cone(const glm::dvec3& axis, double half_angle, double s, double t) {
  const double cosine = 1 - s * (1 - std::cos(half_angle)), angle = 2 * std::numbers::pi * t;
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  const glm::dvec3 least = std::abs(axis.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 across = glm::normalize(glm::cross(axis, least));
  return cosine * axis + sine * (std::cos(angle) * across + std::sin(angle) * glm::cross(axis, across));
}

/// Irradiance of planes and of small cylinders: the mean irradiance of a curved surface is that of the planes
/// which touch it.
class IrradianceMeters final : public SurfaceSensors {
 public:
  IrradianceMeters(const LightPaths& paths, const Receiver& receiver)
      : SurfaceSensors(paths),
        receiver_(receiver),
        normal_(receiver.is_grid() ? glm::normalize(glm::cross(receiver.u, receiver.v)) : receiver.direction),
        sideways_(glm::cross(receiver.direction, receiver.facing)) {}

  [[nodiscard]] std::size_t size() const override { return receiver_.size(); }
  [[nodiscard]] double weight(std::size_t sensor) const override {
    return receiver_.measures(sensor) ? 1 : 0;
  }
  [[nodiscard]] bool may_show_nothing() const override { return false; }
  [[nodiscard]] bool has_light() const override { return light_paths().has_light(); }

 private:
  [[nodiscard]] SensorStart start_at(std::size_t sensor, const std::array<double, 4>& even,
                                     OwenSobol& numbers) const override {
    const auto [s, t, u, v] = even;
    const glm::dvec3 position = receiver_.place(sensor, s, t);
    const glm::dvec3 normal = normal_at(s, numbers);
    return {{{position, normal}, {u, v}, numbers}};
  }

  /// `s` is free where the receiver has points.
  [[nodiscard]] glm::dvec3 normal_at(double s, OwenSobol& numbers) const {
    if (receiver_.quantity == Quantity::irradiance) return normal_;
    const double around = receiver_.is_grid() ? numbers.next()[0] : s;
    const double angle =
        std::numbers::pi * (receiver_.quantity == Quantity::cylindrical ? 2 * around : around - 0.5);
    return std::cos(angle) * receiver_.facing + std::sin(angle) * sideways_;
  }

  const Receiver& receiver_;
  glm::dvec3 normal_, sideways_;
};

class RadianceMeters final : public SightSensors {
 public:
  RadianceMeters(const LightPaths& paths, const Receiver& receiver)
      : SightSensors(paths), receiver_(receiver) {}

  [[nodiscard]] std::size_t size() const override { return receiver_.size(); }
  [[nodiscard]] double weight(std::size_t sensor) const override {
    return receiver_.measures(sensor) ? 1 : 0;
  }

 private:
  [[nodiscard]] Ray sight(std::size_t sensor, double s, double t, OwenSobol& numbers) const override {
    const glm::dvec3 from = receiver_.place(sensor, s, t);
    if (receiver_.is_grid()) {
      const auto drawn = numbers.next();
      s = drawn[0], t = drawn[1];
    }
    return {from, uniform_in_cone(receiver_.direction, receiver_.half_angle, s, t)};
  }

  const Receiver& receiver_;
};

/// What surfaces scatter to eyes.
class EyeMeters final : public SurfaceSensors {
 public:
  EyeMeters(const LightPaths& paths, std::span<const Observer> observers)
      : SurfaceSensors(paths), observers_(observers) {}

  [[nodiscard]] std::size_t size() const override { return observers_.size(); }
  [[nodiscard]] double weight(std::size_t /*sensor*/) const override { return 1; }
  [[nodiscard]] bool may_show_nothing() const override { return false; }

 private:
  [[nodiscard]] SensorStart start_at(std::size_t sensor, const std::array<double, 4>& even,
                                     OwenSobol& numbers) const override {
    const Observer& of = observers_[sensor];
    return {{{of.eye, of.direction}, {even[0], even[1]}, numbers, std::nullopt, true}};
  }

  std::span<const Observer> observers_;
};

}  // namespace

std::unique_ptr<PathSensors> receiver_sensors(const LightPaths& paths, const Receiver& receiver) {
  if (receiver.quantity == Quantity::radiance) return std::make_unique<RadianceMeters>(paths, receiver);
  return std::make_unique<IrradianceMeters>(paths, receiver);
}

std::unique_ptr<PathSensors> observer_sensors(const LightPaths& paths, std::span<const Observer> observers) {
  return std::make_unique<EyeMeters>(paths, observers);
}

}  // namespace fluxel
