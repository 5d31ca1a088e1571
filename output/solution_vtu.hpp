#pragma once

#include <filesystem>

#include "output/run_record.hpp"

namespace fluxel {

/// Writes solution.vtu: radiosity, irradiance, exitance [W/m2] or [lm/m2] and reflectance of the sides of
/// each element, or of each face of Solution::mesh, with noise and, where the run's error is one of surfaces,
/// error; in heat runs their temperature [K], net flux [W/m2] and emissivity; the numbers of patch, group,
/// material and unknown sides, and as a comment the names of groups and materials. Throws InputError where it
/// cannot.
void write_solution_vtu(const std::filesystem::path& file, const RunRecord& record);

}  // namespace fluxel
