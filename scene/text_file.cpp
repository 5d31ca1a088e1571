#include "scene/text_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdint>
#include <fstream>
#include <system_error>

#include "core/input_error_at.hpp"

namespace fluxel {
namespace {

constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{4} << 30;

}  // namespace

std::optional<std::string> read_text_file(const std::filesystem::path& file) {
  std::error_code status;
  if (!std::filesystem::exists(file, status)) return std::nullopt;
  if (std::filesystem::is_directory(file, status))
    throw input_error_at(file, 0, "this is a folder, not a file");
  const std::uintmax_t bytes = std::filesystem::file_size(file, status);
  if (status) throw input_error_at(file, 0, "this is not a regular file");
  if (bytes > kMaxFileBytes) {
    throw input_error_at(file, 0, fmt::format("{} bytes are too many", bytes),
                         fmt::format("at most {}", kMaxFileBytes));
  }
  std::string text(bytes, '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream || !stream.read(text.data(), static_cast<std::streamsize>(bytes))) {
    throw input_error_at(file, 0, "cannot be read", std::generic_category().message(errno));
  }
  return text;
}

}  // namespace fluxel
