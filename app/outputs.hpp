#pragma once

#include <filesystem>

#include "app/report.hpp"
#include "core/raster.hpp"
#include "mpi_master/subdivision_job.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// Writes image.exr and image.png (with a camera) and solution.ply into the run's folder, and adds what it
/// chose to the report. A solution that is not finite is not written, with a warning. Throws InputError where
/// a file cannot be written.
void write_outputs(const Scene& scene, const SubdividedScene& subdivided, RunReport& report);

}  // namespace fluxel
