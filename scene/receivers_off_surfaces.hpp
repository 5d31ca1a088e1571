#pragma once

#include "scene/scene.hpp"

namespace fluxel {

/// Moves points of receivers that lie in surfaces which cross their plane, as the ends of a line from wall to
/// wall do, to where they see the room: by what counts as touching, to the used side, of two-sided surfaces
/// to that of the receiver's other points. Points on what they face stay: light meters lie on floors. Says
/// in the scene's notes what it has moved.
void move_receivers_off_surfaces(Scene& scene);

}  // namespace fluxel
