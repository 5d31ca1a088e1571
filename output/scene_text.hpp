#pragma once

#include <string>

#include "optics/luminaire_doubts.hpp"
#include "scene/scene.hpp"
#include "scene/scene_input.hpp"

namespace fluxel {

/// What a scene holds, in tables for reading: files, size, faces and how they are joined, materials with
/// what they emit, luminaires, cameras, receivers, what reading has left out, and what is suspicious.
[[nodiscard]] std::string scene_text(const SceneInput& input, const Scene& scene,
                                     const LuminaireDoubts& luminaires);

}  // namespace fluxel
