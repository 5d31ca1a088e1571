#pragma once

#include <span>
#include <string>

#include "output/elements/element_file.hpp"
#include "output/html/shown_mesh.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// The elements of a scene, with names of their groups and materials; layers are the caller's to add.
[[nodiscard]] MeshToShow mesh_to_show(const Scene& scene, const ElementView& mesh, const glm::dvec3& up);

/// Of elements of a file that are of the scene; corners are recentred as its are.
[[nodiscard]] MeshToShow mesh_to_show(const Scene& scene, const FileElements& elements, const glm::dvec3& up);

/// Values of fronts and backs of elements, where they are unknowns: layers `name` and, where a back is one,
/// `name_back`.
void add_sides(const ElementView& mesh, const std::string& name, std::span<const Rgb> fronts,
               std::span<const Rgb> backs, MeshToShow& shown);

}  // namespace fluxel
