#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>

#include "scene/readers/glb_container.hpp"

namespace fluxel {

/// Parses and checks the JSON of a glTF file: types, ranges and indices of what Fluxel reads are as they
/// should be. Throws InputError: with line or byte for text that is no JSON or is nested more than 64 deep,
/// with the JSON path otherwise.
[[nodiscard]] std::shared_ptr<const nlohmann::json> parse_gltf(const std::filesystem::path& file,
                                                               const GltfParts& parts);

}  // namespace fluxel
