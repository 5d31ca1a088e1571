#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace fluxel {

/// The parts of a glTF file, which point into its bytes.
struct GltfParts {
  std::string_view json;
  std::size_t json_at = 0;                                ///< byte of the file where the JSON begins
  std::optional<std::string_view> binary = std::nullopt;  ///< of a GLB: the bytes of its first buffer, padded
};

/// Tells a GLB (Khronos Group 2021, glTF 2.0, section 4.4) by its first bytes and takes it apart; other bytes
/// are JSON as a whole. `bytes` outlives the parts. Throws InputError with file and byte where a header or a
/// chunk says more than the file has.
[[nodiscard]] GltfParts split_gltf(const std::filesystem::path& file, const std::string& bytes);

}  // namespace fluxel
