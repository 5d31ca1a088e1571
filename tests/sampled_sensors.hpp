#pragma once

#include "reference/sensors.hpp"

namespace fluxel {

/// Sensors for tests, whose paths bring what a function says.
class SampledSensors : public Sensors {
 public:
  void measure(std::span<const SensorPath> paths, std::span<Rgb> found, std::uint64_t& rays) const final {
    for (std::size_t k = 0; k < paths.size(); ++k) found[k] = sample(paths[k].sensor, paths[k].numbers, rays);
  }

  [[nodiscard]] bool has_light() const override { return true; }

 private:
  [[nodiscard]] virtual Rgb sample(std::size_t sensor, OwenSobol numbers, std::uint64_t& rays) const = 0;
};

}  // namespace fluxel
