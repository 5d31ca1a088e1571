#pragma once

#include "core/element.hpp"
#include "scene/scene.hpp"
#include "subdivision/bisection.hpp"

namespace fluxel {

/// Appends the element of a patch with this outline, in single precision.
void add_element(const Scene& scene, PatchId id, const Outline3& outline, ElementMesh& mesh);

}  // namespace fluxel
