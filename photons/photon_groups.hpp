#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace fluxel {

/// Into how many groups photons may be parted so that those of one group set out alike, by Halton points:
/// their indices are as far apart as there are groups, N = 2^a 3^b 5^c 7^d, so that each of the four first
/// coordinates of a point, of which its emission is made, differs by less than 2^-a, 3^-b, 5^-c, 7^-d
/// (Dmitriev 2002, equations 17 and 18). Ascending from 1, each a multiple of the one before: the powers are
/// grown one at a time, that of the coarsest coordinate first, while N is at most `most`.
[[nodiscard]] std::vector<std::uint64_t> coherent_groups(std::uint64_t most);

/// Photons of a group at least, where nobody asks for a number of groups.
inline constexpr std::uint64_t kLeastOfGroup = 128;

/// What is known of photons of each group of the finest parting.
struct GroupCounts {
  std::vector<std::uint64_t> gone, changed;  ///< again; of these, with another outcome
};

/// The share of changed photons to be expected of each group of the finest parting: what its own photons say
/// and, as long as they are few, what those of the groups say that set out less alike, coarser and coarser.
[[nodiscard]] std::vector<double> expected_shares(std::span<const std::uint64_t> partings,
                                                  const GroupCounts& counts);

}  // namespace fluxel
