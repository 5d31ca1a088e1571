#include "photons/photon_groups.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace fluxel {

namespace {

/// Photons of a group as many as which those of the next coarser parting count for it.
constexpr double kOfCoarser = 4;

}  // namespace

std::vector<std::uint64_t> coherent_groups(std::uint64_t most) {
  std::array<std::pair<std::uint64_t, std::uint64_t>, 4> bases{{{1, 2}, {1, 3}, {1, 5}, {1, 7}}};
  std::vector<std::uint64_t> partings{1};
  for (;;) {
    auto& [parts, base] = *std::ranges::min_element(bases);
    if (partings.back() > most / base) return partings;
    partings.push_back(partings.back() * base);
    parts *= base;
  }
}

std::vector<double> expected_shares(std::span<const std::uint64_t> partings, const GroupCounts& counts) {
  std::vector<double> coarser{0};
  for (const std::uint64_t groups : partings) {
    std::vector<double> gone(groups, 0), changed(groups, 0);
    for (std::size_t group = 0; group < counts.gone.size(); ++group) {
      gone[group % groups] += static_cast<double>(counts.gone[group]);
      changed[group % groups] += static_cast<double>(counts.changed[group]);
    }
    for (std::size_t group = 0; group < groups; ++group)
      changed[group] =
          (changed[group] + kOfCoarser * coarser[group % coarser.size()]) / (gone[group] + kOfCoarser);
    coarser = std::move(changed);
  }
  return coarser;
}

}  // namespace fluxel
