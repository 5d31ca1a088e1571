#include "scene/list_names.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/nearest_name.hpp"

namespace fluxel {

std::string list_names(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 12;
  const std::size_t shown = std::min(names.size(), kShown);
  std::string list =
      fmt::format("{}", fmt::join(names.begin(), names.begin() + static_cast<long>(shown), ", "));
  if (shown < names.size()) list += fmt::format(" and {} more", names.size() - shown);
  return list;
}

std::string known_names(std::string_view unknown, const std::vector<std::string>& known) {
  const std::string nearest = nearest_name(unknown, known);
  return (nearest.empty() ? "known: " : fmt::format("did you mean '{}'? Known: ", nearest)) +
         list_names(known);
}

}  // namespace fluxel
