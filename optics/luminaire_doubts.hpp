#pragma once

#include <optional>
#include <string>
#include <vector>

#include "visibility/ray_scene.hpp"

namespace fluxel {

/// What a user should know of where luminaires are: a sentence each, of the worst one and the surface.
struct LuminaireDoubts {
  /// Openings that a surface cuts; light on sides which are no unknowns, out of a closed scene, or on a
  /// surface so near that points which are drawn over it hardly find the light.
  std::vector<std::string> warnings;
  std::optional<std::string> note;  ///< of surfaces nearer than the far field of a photometric file holds
};

/// By rays that depend on the scene alone.
[[nodiscard]] LuminaireDoubts luminaire_doubts(const RayScene& ray_scene);

}  // namespace fluxel
