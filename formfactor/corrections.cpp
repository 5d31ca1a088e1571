#include "formfactor/corrections.hpp"

#include <algorithm>
#include <utility>

namespace fluxel {

Corrections compress(std::span<const CorrectionEntry> entries, std::size_t unknowns) {
  Corrections result;
  result.start.assign(unknowns + 1, 0);
  for (const CorrectionEntry& entry : entries) ++result.start[entry.row + 1];
  for (std::size_t row = 0; row < unknowns; ++row) result.start[row + 1] += result.start[row];
  std::vector<std::pair<std::uint32_t, float>> sorted(entries.size());
  std::vector<std::uint64_t> next(result.start.begin(), result.start.end() - 1);
  for (const CorrectionEntry& entry : entries) sorted[next[entry.row]++] = {entry.column, entry.G};
  const auto at = [&](std::uint64_t place) { return sorted.begin() + static_cast<std::ptrdiff_t>(place); };
  for (std::size_t row = 0; row < unknowns; ++row)
    std::sort(at(result.start[row]), at(result.start[row + 1]));
  result.column.reserve(sorted.size());
  result.G.reserve(sorted.size());
  for (const auto& [column, G] : sorted) {
    result.column.push_back(column);
    result.G.push_back(G);
  }
  return result;
}

}  // namespace fluxel
