#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scene/text_file.hpp"

namespace fluxel {

/// The bytes that a URI of a glTF file stands for: base64 data within it, or a file in the folder of `file`
/// or a folder below. `where` is the JSON path of the URI in messages. Throws InputError for URIs that leave
/// the folder, of other schemes, damaged ones, and those of no file.
[[nodiscard]] std::string read_gltf_uri(const std::filesystem::path& file, const std::string& where,
                                        std::string_view uri, const TextLookup& lookup);

}  // namespace fluxel
