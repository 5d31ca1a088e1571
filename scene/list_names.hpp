#pragma once

#include <string>
#include <vector>

namespace fluxel {

/// `a, b, c` for a message; a long list is cut with the number of names left out.
[[nodiscard]] std::string list_names(const std::vector<std::string>& names);

}  // namespace fluxel
