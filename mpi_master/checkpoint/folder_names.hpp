#pragma once

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

namespace fluxel {

/// The names in a folder, ascending; `failed` says why not all of them could be read.
[[nodiscard]] std::vector<std::string> names_in(const std::filesystem::path& folder, std::error_code& failed);

}  // namespace fluxel
