#pragma once

#include <vector>

#include "output/elements/glb_writer.hpp"
#include "output/output_table.hpp"

namespace fluxel {

/// The triangles of each group, shown as the run's picture is: of the mesh that has light of its own at its
/// vertices, else of the elements, with the mean of those around a vertex, by area. Light is smooth over a
/// patch, and patches and sides share no vertex.
[[nodiscard]] std::vector<GlbPart> glb_parts(const OutputSource& source);

/// z is up where it is for the camera.
[[nodiscard]] GlbScene glb_scene(const RunRecord& record);

}  // namespace fluxel
