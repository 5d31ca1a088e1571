#pragma once

#include <string>

#include "method/problem.hpp"
#include "method/solution.hpp"
#include "reference/sensors.hpp"
#include "reference/verified_paths.hpp"

namespace fluxel {

/// Collective: measures sensors of one kind, of one receiver where they are its cells; reports how far it is,
/// and says what it came to. Elements, pixels and the cells of each receiver have random numbers of their
/// own, so that their errors are independent. `columns`: of pixels and cells, by rows; of elements 0.
/// `device`: this rank's GPU, or null.
[[nodiscard]] SensorLight measure_sensors(const Problem& problem, Measured kind, const std::string& receiver,
                                          const PathSensors& sensors, int columns, const PathGoal& goal,
                                          VerifiedPaths* device = nullptr);

}  // namespace fluxel
