#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/input_error_at.hpp"
#include "scene/readers/gltf_value.hpp"
#include "scene/text_file.hpp"

namespace fluxel {

/// A glTF file, parsed, checked, and its buffers read. It points into the bytes that it was opened from.
struct GltfFile {
  std::filesystem::path path;
  std::shared_ptr<const nlohmann::json> document;
  std::map<std::string_view, std::string> read;  ///< bytes of the buffers' URIs
  std::vector<std::string_view> buffers;         ///< each of its byteLength

  /// A member of the document, as the array "nodes".
  [[nodiscard]] GltfValue operator[](std::string_view key) const { return GltfValue(*document)[key]; }

  /// An error at a JSON path, as "accessors[3]".
  [[nodiscard]] InputError error(const std::string& where, const std::string& what,
                                 const std::string& hint = {}) const {
    return input_error_at(path, 0, where + ": " + what, hint);
  }
};

/// "ARRAY[ELEMENT]": the JSON path of an element.
[[nodiscard]] std::string gltf_element(const char* array, std::size_t element);

/// Opens a glTF file or a GLB from its bytes. Throws InputError with byte, line or JSON path.
[[nodiscard]] GltfFile open_gltf(const std::filesystem::path& file, const std::string& bytes,
                                 const TextLookup& lookup);

/// The bytes of a buffer view. Throws InputError where it reaches beyond its buffer.
[[nodiscard]] std::string_view buffer_view_bytes(const GltfFile& gltf, std::size_t view);

}  // namespace fluxel
