#include "method/hierarchy_statistics.hpp"

#include <fmt/format.h>

namespace fluxel {

std::string exchange_text(const HierarchyRound& round) {
  return round.rows > 0 ? fmt::format("rows of rays of {} nodes", round.rows)
                        : fmt::format("{} links between {} nodes", round.links, round.nodes);
}

}  // namespace fluxel
