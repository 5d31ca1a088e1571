#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "scene/patch_mesh.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// The winding number of a component around a point: 1 inside a closed component whose normals point outward,
/// -1 where they point inward, 0 outside; the sum of its patches' solid angles (Van Oosterom & Strackee 1983,
/// eq. 8) over 4 pi.
[[nodiscard]] double winding_number(const Scene& scene, const PatchComponent& component,
                                    const glm::dvec3& point);

/// Of each patch: whether it bounds a closed, consistently oriented component from outside.
[[nodiscard]] std::vector<bool> patches_of_bodies(const Scene& scene, const PatchMesh& mesh);

/// Leaves out of two-sided patches the side that looks into a closed, consistently oriented component which
/// holds neither an emitter nor a luminaire nor the camera and lets no light through: no light reaches it and
/// nobody sees it. Which side looks inside is told by the sign of the enclosed volume. An emitter is inside
/// where the centroid of one of its pieces, just in front of its front, is. `camera_eye` is in world
/// coordinates [m]. Needs the scene's pieces; counts and notes what it left out.
void leave_out_sealed_sides(Scene& scene, const PatchMesh& mesh, std::optional<glm::dvec3> camera_eye);

}  // namespace fluxel
