#include "output/stated_receivers.hpp"

#include <cmath>

namespace fluxel {

std::vector<StatedReceiver> stated_receivers(const Scene& scene, std::span<const SensorLight> sensors,
                                             double relative) {
  std::vector<StatedReceiver> found;
  for (const Receiver& receiver : scene.receivers)
    for (const SensorLight& light : sensors) {
      if (light.kind != Measured::receivers || light.receiver != receiver.name) continue;
      StatedReceiver& one =
          found.emplace_back(StatedReceiver{receiver, light, receiver_figures(receiver, light, relative)});
      for (SensorEstimate& of : one.light.measured.sensors)
        for (int c = 0; c < kChannels; ++c) of.error[c] = std::hypot(of.error[c], relative * of.mean[c]);
    }
  return found;
}

std::vector<StatedReceiver> stated_receivers(const RunRecord& record) {
  return stated_receivers(record.scene, record.solution.sensors, record.solution.expected_error.value_or(0));
}

const char* unit_of(const Receiver& receiver, Units units) {
  if (receiver.quantity == Quantity::radiance) return unit_names(units).radiance;
  return units == Units::photometric ? "lx" : unit_names(units).exitance;
}

}  // namespace fluxel
