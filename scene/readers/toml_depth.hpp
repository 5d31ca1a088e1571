#pragma once

#include <filesystem>
#include <string_view>

namespace fluxel {

/// Refuses a TOML text whose keys have more than 32 dots or whose brackets nest deeper than 32: a parser that
/// descends by recursion would run out of stack. Dots and brackets in quotes and comments do not count. What
/// else is wrong with the text is the parser's to say. Throws InputError with file and line.
void require_shallow_toml(const std::filesystem::path& file, std::string_view text);

}  // namespace fluxel
