#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>

#include "scene/scene_input.hpp"
#include "scene/text_file.hpp"

namespace fluxel {

/// A format of geometry: a line of the table in geometry_formats.cpp.
struct GeometryFormat {
  std::array<std::string_view, 2> extensions;  ///< in lower case, with the dot; empty where there is one less
  /// Reads the bytes of a file. `file` stands in messages, gives the name, and is where the names of other
  /// files start, whose bytes `lookup` gives. Throws InputError with file and, of a text, line.
  SceneInput (*read)(const std::filesystem::path& file, const std::string& bytes, const TextLookup& lookup);
};

/// The format of a file by its extension, in capitals or not; null where there is none of it.
[[nodiscard]] const GeometryFormat* geometry_format(const std::filesystem::path& file);

/// The extensions of all formats, as a list for messages.
[[nodiscard]] std::string geometry_extensions();

/// The extension of a file in lower case, with its dot.
[[nodiscard]] std::string lower_extension(const std::filesystem::path& file);

}  // namespace fluxel
