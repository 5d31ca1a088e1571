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
  const SensorLight& light;  ///< the errors are those of its rays
  ReceiverFigures figures;
  double relative = 0;    ///< the error of the solution, over the value
  std::string unreached;  ///< what was asked for and has not been reached; empty: nothing

  /// Of a cell or point [the receiver's unit]: that of its rays and of the solution together.
  [[nodiscard]] Rgb error(std::size_t cell) const;
};

/// The receivers that were measured, in the scene's order; what is given must outlive them. `relative`: the
/// error of the solution; of references 0.
[[nodiscard]] std::vector<StatedReceiver> stated_receivers(const Scene& scene,
                                                           std::span<const SensorLight> sensors,
                                                           double relative);

[[nodiscard]] std::vector<StatedReceiver> stated_receivers(const RunRecord& record);

/// The unit of what it measures.
[[nodiscard]] const char* unit_of(const Receiver& receiver, Units units);

}  // namespace fluxel
