#pragma once

#include <string>

namespace fluxel {

/// A CSV field (RFC 4180): in quotes where it holds commas, quotes or ends of lines, as names of groups may.
[[nodiscard]] std::string csv_field(const std::string& text);

}  // namespace fluxel
