#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace fluxel {

/// What makes a built scene suspicious, a sentence each, with what it means for the light: edges where
/// patches face opposite ways, gaps, overlaps, reflectances that are hardly real.
[[nodiscard]] std::vector<std::string> doubts_of(const Scene& scene);

}  // namespace fluxel
