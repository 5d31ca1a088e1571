#pragma once

#include <cstdint>

namespace fluxel {

/// Into how many groups photons are parted so that those of one group set out alike, by Halton points: their
/// indices are as far apart as there are groups, N = 2^a 3^b 5^c 7^d, so that each of the four coordinates of
/// the emission differs by less than 2^-a, 3^-b, 5^-c, 7^-d (Dmitriev 2002, equations 17 and 18). The powers
/// are grown one at a time, that of the coarsest coordinate first, while N is at most `most`.
[[nodiscard]] std::uint64_t coherent_groups(std::uint64_t most);

/// Photons of a group at least, where nobody asks for a number of groups.
inline constexpr std::uint64_t kLeastOfGroup = 128;

}  // namespace fluxel
