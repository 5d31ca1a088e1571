#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/readers/glb_container.hpp"

namespace fluxel {

/// A buffer or an image of a glTF file, before its bytes are read.
struct GltfSource {
  std::optional<std::string> uri;
  std::optional<std::size_t> buffer_view;  ///< of an image
  std::uint64_t byte_length = 0;           ///< of a buffer
};

/// The JSON of a glTF file after the check: types, ranges and indices are as they should be, so that a parser
/// can no longer meet a bad value.
struct GltfDocument {
  std::string json;  ///< without what stands below, skins and `extras`
  std::vector<GltfSource> buffers, images;
  std::size_t animations = 0, skins = 0;
};

/// Checks the JSON of a glTF file. Throws InputError: with line or byte for text that is no JSON or is nested
/// more than 64 deep, with the JSON path otherwise.
[[nodiscard]] GltfDocument check_gltf(const std::filesystem::path& file, const GltfParts& parts);

}  // namespace fluxel
