#include "output/stated_receivers.hpp"

#include <glm/exponential.hpp>

#include "output/outcome.hpp"

namespace fluxel {

Rgb StatedReceiver::error(std::size_t cell) const {
  const SensorEstimate& of = light.measured.sensors[cell];
  return glm::sqrt(of.error * of.error + relative * relative * of.mean * of.mean);
}

std::vector<StatedReceiver> stated_receivers(const Scene& scene, std::span<const SensorLight> sensors,
                                             double relative) {
  std::vector<StatedReceiver> found;
  for (const Receiver& receiver : scene.receivers)
    for (const SensorLight& light : sensors) {
      if (light.kind != Measured::receivers || light.receiver != receiver.name) continue;
      found.push_back({receiver, light, receiver_figures(receiver, light, relative), relative,
                       unreached(light.measured)});
    }
  return found;
}

std::vector<StatedReceiver> stated_receivers(const RunRecord& record) {
  std::vector<StatedReceiver> found =
      stated_receivers(record.scene, record.solution.sensors, record.solution.expected_error.value_or(0));
  // Nobody has asked for the error of a solution's receivers.
  for (StatedReceiver& of : found) of.unreached = unreached(record);
  return found;
}

const char* unit_of(const Receiver& receiver, Units units) {
  if (receiver.quantity == Quantity::radiance) return unit_names(units).radiance;
  return units == Units::photometric ? "lx" : unit_names(units).exitance;
}

}  // namespace fluxel
