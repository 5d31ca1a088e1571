#pragma once

#include "core/element.hpp"
#include "scene/scene.hpp"
#include "subdivision/bisection.hpp"

namespace fluxel {

/// The element of a patch with this outline, in single precision.
[[nodiscard]] Element make_element(const Scene& scene, PatchId id, const Outline3& outline);

/// In single precision.
[[nodiscard]] Outline<glm::vec3> narrow(const Outline3& outline);

/// Appends both to a mesh.
void add_element(const Scene& scene, PatchId id, const Outline3& outline, ElementMesh& mesh);

}  // namespace fluxel
