#include "output/stated_receivers.hpp"

#include "output/outcome.hpp"

namespace fluxel {

std::vector<StatedReceiver> stated_receivers(const Scene& scene, std::span<const SensorLight> sensors) {
  std::vector<StatedReceiver> found;
  for (const Receiver& receiver : scene.receivers)
    for (const SensorLight& light : sensors) {
      if (light.kind != Measured::receivers || light.receiver != receiver.name) continue;
      found.push_back({receiver, light, receiver_figures(receiver, light), unreached(light.measured)});
    }
  return found;
}

std::vector<StatedReceiver> stated_receivers(const RunRecord& record) {
  return stated_receivers(record.scene, record.solution.sensors);
}

const char* unit_of(const Receiver& receiver, Units units) {
  if (receiver.quantity == Quantity::radiance) return unit_names(units).radiance;
  return units == Units::photometric ? "lx" : unit_names(units).exitance;
}

}  // namespace fluxel
