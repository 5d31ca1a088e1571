#pragma once

#include "scene/scene_input.hpp"

namespace fluxel {

/// Brings what a file says of places and directions (polygons, cameras, luminaires) into the scene, as
/// `geometry` says. The corners of a mirrored polygon are reversed, so that its front stays the front, and so
/// are the C planes of a mirrored luminaire.
void place(SceneInput& part, const InputGeometry& geometry);

}  // namespace fluxel
