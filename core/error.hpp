#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace fluxel {

/// The user's input cannot be used: the message says what, where and what to do. The program exits with 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An input error at a place in a file: `FILE:LINE: WHAT (HINT)`. A line of 0 is left out, as is an empty
/// hint.
[[nodiscard]] InputError input_error_at(const std::filesystem::path& file, std::size_t line,
                                        const std::string& what, const std::string& hint = {});

}  // namespace fluxel
