#pragma once

#include <string_view>

namespace fluxel {

struct Options;

/// Why an option has no effect beside the others; empty where it has. What has none is no part of the report,
/// and a warning says it to those who gave it.
[[nodiscard]] std::string_view idle_reason(std::string_view option, const Options& options);

}  // namespace fluxel
