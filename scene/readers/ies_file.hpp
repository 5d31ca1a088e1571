#pragma once

#include <filesystem>
#include <string>

#include "scene/readers/photometric_file.hpp"

namespace fluxel {

/// Reads the text of a photometric file of ANSI/IES LM-63 (1986, 1991, 1995, 2002 or 2019) of type C.
/// Symmetries are expanded. A file with the line `[_INTENSITYUNITS] mW/sr` or `W/sr` is radiometric. Luminous
/// openings of any height are flat. `file` stands in messages. Throws InputError with file and line.
[[nodiscard]] PhotometricFile read_ies_text(const std::filesystem::path& file, const std::string& bytes);

}  // namespace fluxel
