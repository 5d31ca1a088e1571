#pragma once

#include <filesystem>
#include <string>

#include "scene/readers/photometric_file.hpp"

namespace fluxel {

/// Reads the text of an EULUMDAT file (Stockmar 1990 and 1998), with the lamps of its first set. Symmetries
/// are expanded; luminous areas of any height are flat. `file` stands in messages. Throws InputError with
/// file and line.
[[nodiscard]] PhotometricFile read_eulumdat_text(const std::filesystem::path& file, const std::string& bytes);

}  // namespace fluxel
