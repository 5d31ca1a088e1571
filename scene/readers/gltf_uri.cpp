#include "scene/readers/gltf_uri.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <optional>

#include "core/input_error_at.hpp"
#include "scene/readers/statements.hpp"

namespace fluxel {
namespace {

/// The value of a base64 digit (RFC 4648, table 1), or nothing.
std::optional<std::uint32_t> base64_value(char digit) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  static const std::array<std::uint8_t, 256> values = [] {
    std::array<std::uint8_t, 256> table{};
    table.fill(64);
    for (std::size_t k = 0; k < kDigits.size(); ++k)
      table[static_cast<unsigned char>(kDigits[k])] = static_cast<std::uint8_t>(k);
    return table;
  }();
  const std::uint8_t value = values[static_cast<unsigned char>(digit)];
  return value == 64 ? std::nullopt : std::optional<std::uint32_t>(value);
}

/// Nothing where the text is no base64; the padding at its end may be left out.
std::optional<std::string> decode_base64(std::string_view text) {
  for (int k = 0; k < 2 && text.ends_with('='); ++k) text.remove_suffix(1);
  if (text.size() % 4 == 1) return std::nullopt;
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int held = 0;
  for (const char digit : text) {
    const std::optional<std::uint32_t> value = base64_value(digit);
    if (!value) return std::nullopt;
    bits = bits << 6 | *value;
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes.push_back(static_cast<char>(bits >> held & 0xFFu));
  }
  return bytes;
}

/// Nothing where a percent sign has no two hexadecimal digits behind it.
std::optional<std::string> decode_percent(std::string_view text) {
  std::string decoded;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] != '%') {
      decoded.push_back(text[k]);
      continue;
    }
    unsigned code = 0;
    const std::string_view digits = text.substr(k + 1, 2);
    const char* const end = digits.data() + digits.size();
    if (digits.size() < 2 || std::from_chars(digits.data(), end, code, 16).ptr != end) return std::nullopt;
    decoded.push_back(static_cast<char>(code));
    k += 2;
  }
  return decoded;
}

bool has_scheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  return colon != std::string_view::npos && uri.find('/') > colon;
}

bool leaves_folder(const std::filesystem::path& path) {
  return path.is_absolute() || std::ranges::find(path, "..") != path.end();
}

}  // namespace

std::string read_gltf_uri(const std::filesystem::path& file, const std::string& where, std::string_view uri,
                          const TextLookup& lookup) {
  const auto error = [&](const std::string& what, const std::string& hint) {
    return input_error_at(file, 0, fmt::format("{}: {}", where, what), hint);
  };
  if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64"))
      throw error("the data are not marked as base64", "data:application/octet-stream;base64,...");
    std::optional<std::string> bytes = decode_base64(uri.substr(comma + 1));
    if (!bytes) throw error("the data are no base64", "the file is damaged");
    return std::move(*bytes);
  }
  const std::optional<std::string> name = decode_percent(uri);
  if (!name || name->empty() || name->find('\0') != std::string::npos)
    throw error(fmt::format("{} is no file name", in_quotes(uri)), "the file is damaged");
  if (has_scheme(*name) || name->find('\\') != std::string::npos || leaves_folder(*name)) {
    throw error(fmt::format("{} is not a file in the folder of the glTF file", in_quotes(uri)),
                "put it there, and name it relative to the folder");
  }
  const std::filesystem::path path = file.parent_path() / *name;
  std::optional<std::string> bytes = lookup(path);
  if (!bytes)
    throw error(fmt::format("cannot find {}", in_quotes(path.string())), "it belongs to the glTF file");
  return std::move(*bytes);
}

}  // namespace fluxel
