#pragma once

#include <span>
#include <string>
#include <string_view>

namespace fluxel {

/// Letters to change, add, leave out or swap with their neighbour until `a` is `b`, each pair of neighbours
/// swapped once (Damerau 1964; optimal string alignment).
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// The name that a misspelled word most likely means: the first of the least distance, at most a third of the
/// word's letters and at most 2. Empty where none is as near.
[[nodiscard]] std::string nearest_name(std::string_view word, std::span<const std::string> names);

}  // namespace fluxel
