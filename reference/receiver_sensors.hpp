#pragma once

#include <memory>
#include <span>

#include "reference/sensors.hpp"
#include "scene/observer.hpp"
#include "scene/receiver.hpp"

namespace fluxel {

/// What a receiver measures at each of its cells, its mean over the cell, or points, as the pixels of a
/// picture: row 0 is the last along v. Cells that are left out weigh nothing. The receiver must outlive this.
[[nodiscard]] std::unique_ptr<PathSensors> receiver_sensors(const LightPaths& paths,
                                                            const Receiver& receiver);

/// The irradiance of each observer's eye, on the plane at right angles to where it looks [W/m2] or [lx].
[[nodiscard]] std::unique_ptr<PathSensors> observer_sensors(const LightPaths& paths,
                                                            std::span<const Observer> observers);

}  // namespace fluxel
