#pragma once

#include <string>
#include <vector>

#include "scene/readers/gltf_file.hpp"
#include "scene/readers/gltf_nodes.hpp"

namespace fluxel {

/// Throws InputError, with their names, where the file cannot be understood without extensions that Fluxel
/// does not know.
void require_known_extensions(const GltfFile& gltf);

/// What the file says that is left out or taken for something else: a note for each kind, with a count.
[[nodiscard]] std::vector<std::string> gltf_notes(const GltfFile& gltf, const std::vector<GltfNode>& nodes);

}  // namespace fluxel
