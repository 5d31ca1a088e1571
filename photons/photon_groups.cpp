#include "photons/photon_groups.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace fluxel {

std::uint64_t coherent_groups(std::uint64_t most) {
  std::array<std::pair<std::uint64_t, std::uint64_t>, 4> bases{{{1, 2}, {1, 3}, {1, 5}, {1, 7}}};
  std::uint64_t groups = 1;
  for (;;) {
    auto& [parts, base] = *std::ranges::min_element(bases);
    if (groups > most / base) return groups;
    groups *= base;
    parts *= base;
  }
}

}  // namespace fluxel
