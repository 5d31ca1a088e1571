#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/element.hpp"
#include "core/surface_light.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// Writes the solution as binary little-endian PLY (Turk 1994): a face for each element, in their order, with
/// the properties `float radiosity_r, radiosity_g, radiosity_b` of its front [W/m2], where there are back
/// unknowns also `float radiosity_back_r, radiosity_back_g, radiosity_back_b`, and `uint patch`. Vertices are
/// in world metres, in double precision: far from the world's origin single precision would move them.
/// Corners at equal coordinates are one vertex, except those of a face that would make the mesh non-manifold:
/// it has its own. The file depends on the arguments and the program's version alone. Throws InputError where
/// the file cannot be written (nothing then stands under its name), std::logic_error where a radiosity is not
/// finite in single precision or a vector has not one entry for each element.
void write_solution(const std::filesystem::path& file, const Scene& scene, const ElementView& mesh,
                    const SurfaceLight& light);

/// The radiosities of such a file, fronts, then (in two-sided scenes) backs. Throws InputError where it
/// cannot be read, is of other elements, or holds what is not finite; the version that wrote it does not
/// matter.
[[nodiscard]] std::vector<Rgb> read_solution(const std::filesystem::path& file, const Scene& scene,
                                             const ElementView& mesh, bool two_sided);

/// The same from the file's bytes.
[[nodiscard]] std::vector<Rgb> solution_of_bytes(const std::filesystem::path& file, std::string bytes,
                                                 const Scene& scene, const ElementView& mesh, bool two_sided);

}  // namespace fluxel
