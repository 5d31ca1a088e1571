#pragma once

#include <optional>

#include "method/light_map.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// A chart for each side of a piece that is an unknown, packed into a map. `texel`: the largest step [m];
/// unset: the least one, within a few hundredths, with which they fit into 1024 x 1024 texels, or into a
/// larger map where so many sides have no room in that one. Lattices go along the longest edge of the largest
/// piece of a plane, with texels in its corners. Charts keep kLightMapPadding texels to each side.
/// Throws InputError where the map would be larger than 4096 x 4096.
[[nodiscard]] LightMapLayout lay_out(const Scene& scene, std::optional<double> texel);

/// Texels around a chart that are filled with the nearest of its own.
inline constexpr int kLightMapPadding = 2;

}  // namespace fluxel
