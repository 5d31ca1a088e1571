#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>

#include "scene/readers/photometric_file.hpp"

namespace fluxel {

/// A format of photometric data: a line of the table in photometric_formats.cpp.
struct PhotometricFormat {
  std::array<std::string_view, 2> extensions;  ///< in lower case, with the dot; empty where there is one less
  /// Reads the bytes of a file. `file` stands in messages. Throws InputError with file and line.
  PhotometricFile (*read)(const std::filesystem::path& file, const std::string& bytes);
};

/// The format of a file by its extension, in capitals or not; null where there is none of it.
[[nodiscard]] const PhotometricFormat* photometric_format(const std::filesystem::path& file);

/// The extensions of all formats, as a list for messages.
[[nodiscard]] std::string photometric_extensions();

}  // namespace fluxel
