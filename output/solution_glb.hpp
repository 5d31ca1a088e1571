#pragma once

#include <filesystem>

#include "output/output_table.hpp"

namespace fluxel {

/// Writes solution.glb: a node a group, triangles smooth across the elements of a patch, shown as the run's
/// picture is; backs are triangles of their own where they are unknowns. Lies on its back where the camera
/// has z up, as glTF has y up. Throws InputError where it cannot.
void write_solution_glb(const std::filesystem::path& file, const OutputSource& source);

/// Writes solution-quantised.glb: the same in about half as many bytes, see GlbEncoding.
void write_quantised_glb(const std::filesystem::path& file, const OutputSource& source);

}  // namespace fluxel
