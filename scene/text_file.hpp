#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace fluxel {

/// Gives the text of a file, or nothing where there is no such file.
using TextLookup = std::function<std::optional<std::string>(const std::filesystem::path&)>;

/// The whole file; nothing where there is none. Throws InputError for a folder, an unreadable file and one of
/// more than 4 GiB.
[[nodiscard]] std::optional<std::string> read_text_file(const std::filesystem::path& file);

}  // namespace fluxel
