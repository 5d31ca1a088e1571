#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fluxel {

/// `a, b, c` for a message; a long list is cut with the number of names left out.
[[nodiscard]] std::string list_names(const std::vector<std::string>& names);

/// `did you mean 'b'? Known: a, b, c` for a message on an unknown name; the question only where a name is
/// near.
[[nodiscard]] std::string known_names(std::string_view unknown, const std::vector<std::string>& known);

}  // namespace fluxel
