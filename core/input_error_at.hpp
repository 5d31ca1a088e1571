#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "core/error.hpp"

namespace fluxel {

/// An input error at a place in a file: `FILE:LINE: WHAT (HINT)`. A line of 0 is left out, as is an empty
/// hint.
[[nodiscard]] InputError input_error_at(const std::filesystem::path& file, std::size_t line,
                                        const std::string& what, const std::string& hint = {});

}  // namespace fluxel
