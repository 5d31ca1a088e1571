#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace fluxel {

/// Checks what Fluxel reads of a glTF document: types, array lengths and ranges of values, as the JSON schema
/// of glTF 2.0 (Khronos Group 2021, appendix A) and of the extensions has them, and that each index has
/// its element. Throws InputError with the JSON path.
void check_gltf_schema(const std::filesystem::path& file, const nlohmann::json& root);

}  // namespace fluxel
