#include "core/input_error_at.hpp"

#include <fmt/format.h>

namespace fluxel {

InputError input_error_at(const std::filesystem::path& file, std::size_t line, const std::string& what,
                          const std::string& hint) {
  const std::string place = line == 0 ? file.string() : fmt::format("{}:{}", file.string(), line);
  return InputError(hint.empty() ? fmt::format("{}: {}", place, what)
                                 : fmt::format("{}: {} ({})", place, what, hint));
}

}  // namespace fluxel
