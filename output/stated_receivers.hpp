#pragma once

#include <span>
#include <string>
#include <vector>

#include "method/solution.hpp"
#include "output/receiver_figures.hpp"
#include "output/run_record.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// A receiver and what it has measured.
struct StatedReceiver {
  const Receiver& receiver;
  const SensorLight& light;
  ReceiverFigures figures;
  std::string unreached;  ///< what was asked for and has not been reached; empty: nothing
};

/// The receivers that were measured, in the scene's order; what is given must outlive them.
[[nodiscard]] std::vector<StatedReceiver> stated_receivers(const Scene& scene,
                                                           std::span<const SensorLight> sensors);

[[nodiscard]] std::vector<StatedReceiver> stated_receivers(const RunRecord& record);

/// The unit of what it measures.
[[nodiscard]] const char* unit_of(const Receiver& receiver, Units units);

}  // namespace fluxel
