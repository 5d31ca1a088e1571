#pragma once

#include "core/rgb.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// Where the flux of a scene's luminaires does not reach an unknown side [W] or [lm], for each colour.
struct LuminaireEscape {
  Rgb flux{0};     ///< of all luminaires
  Rgb escaped{0};  ///< that leaves the scene
  Rgb dark{0};     ///< that ends on sides which are no unknowns
  Rgb error{0};    ///< standard error of escaped + dark
};

/// By rays in directions that are drawn by the luminaires' intensity; depends on the scene alone.
[[nodiscard]] LuminaireEscape luminaire_escape(const RayScene& ray_scene);

}  // namespace fluxel
