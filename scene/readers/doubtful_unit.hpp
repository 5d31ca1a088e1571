#pragma once

#include <optional>
#include <string>

#include "scene/scene_input.hpp"

namespace fluxel {

/// A sentence where the scene is wider than 1,000 m or narrower than 0.05 m and a file of it was read without
/// a unit, so that metres were assumed: which unit would make a room of it, and how to give it. Else none.
[[nodiscard]] std::optional<std::string> doubt_of_unit(const SceneInput& input);

}  // namespace fluxel
