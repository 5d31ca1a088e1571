#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "reference/sensors.hpp"

namespace fluxel {

/// Sensors whose paths start at points that light falls on.
class SurfaceSensors : public PathSensors {
 public:
  using PathSensors::PathSensors;

  void start(std::span<const SensorPath> paths, std::vector<SensorStart>& started,
             std::uint64_t& rays) const final;

 private:
  /// From numbers that are even together; others may be drawn.
  [[nodiscard]] virtual SensorStart start_at(std::size_t sensor, const std::array<double, 4>& even,
                                             OwenSobol& numbers) const = 0;
};

/// Sensors of the radiance of what they see: paths start where a ray meets the first side, or with this ray
/// where the side is not diffuse.
class SightSensors : public PathSensors {
 public:
  using PathSensors::PathSensors;

  void start(std::span<const SensorPath> paths, std::vector<SensorStart>& started,
             std::uint64_t& rays) const final;

 private:
  /// From two numbers that are even together; others may be drawn.
  [[nodiscard]] virtual Ray sight(std::size_t sensor, double s, double t, OwenSobol& numbers) const = 0;
};

}  // namespace fluxel
