#include "method/hierarchy_statistics.hpp"

#include <fmt/format.h>

namespace fluxel {

std::string exchange_text(const HierarchyRound& round) {
  return round.rows > 0 ? fmt::format("rows of rays of {} nodes", round.rows)
                        : fmt::format("{} links between {} nodes", round.links, round.nodes);
}

void sum_counts(const Communicator& world, const Hierarchy& hierarchy, HierarchyStatistics& statistics) {
  const RefinementCounts& counts = hierarchy.counts();
  std::array<std::uint64_t, 5> sums{counts.pairs, counts.shafts, counts.contours, counts.rays,
                                    hierarchy.gather_rays()};
  world.all_sum(sums);
  statistics.pairs = sums[0], statistics.shafts = sums[1], statistics.contours = sums[2];
  statistics.rays = sums[3], statistics.gather_rays = sums[4];
  auto bytes = static_cast<double>(hierarchy.bytes());
  world.all_max(std::span(&bytes, 1));
  statistics.bytes = static_cast<std::uint64_t>(bytes);
}

}  // namespace fluxel
