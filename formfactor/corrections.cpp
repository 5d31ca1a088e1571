#include "formfactor/corrections.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace fluxel {

namespace {

/// Of a part of a list [entries]: 768 kB.
constexpr std::size_t kPart = 65536;

/// Sorts the columns of a row, each with its G.
void sort_row(std::span<std::uint32_t> column, std::span<float> G,
              std::vector<std::pair<std::uint32_t, float>>& pairs) {
  pairs.clear();
  for (std::size_t k = 0; k < column.size(); ++k) pairs.emplace_back(column[k], G[k]);
  std::ranges::sort(pairs);
  for (std::size_t k = 0; k < column.size(); ++k) std::tie(column[k], G[k]) = pairs[k];
}

}  // namespace

void CorrectionList::add(std::span<const CorrectionEntry> entries) {
  while (!entries.empty()) {
    if (parts_.empty() || parts_.back().size() == kPart) parts_.emplace_back().reserve(kPart);
    std::vector<CorrectionEntry>& part = parts_.back();
    const std::size_t count = std::min(entries.size(), kPart - part.size());
    part.insert(part.end(), entries.begin(), entries.begin() + static_cast<std::ptrdiff_t>(count));
    entries = entries.subspan(count);
  }
}

std::size_t CorrectionList::size() const {
  return parts_.empty() ? 0 : (parts_.size() - 1) * kPart + parts_.back().size();
}

Corrections compress(CorrectionList entries, std::size_t unknowns) {
  Corrections result;
  const std::size_t size = entries.size();
  std::vector<std::vector<CorrectionEntry>> parts = entries.take();
  result.start.assign(unknowns + 1, 0);
  for (const auto& part : parts)
    for (const CorrectionEntry& entry : part) ++result.start[entry.row + 1];
  for (std::size_t row = 0; row < unknowns; ++row) result.start[row + 1] += result.start[row];
  result.column.resize(size);
  result.G.resize(size);
  // A row's start is moved to its end on the way, which is where the next row starts.
  for (auto& part : parts) {
    for (const CorrectionEntry& entry : std::exchange(part, {})) {
      const std::uint64_t at = result.start[entry.row]++;
      result.column[at] = entry.column;
      result.G[at] = entry.G;
    }
  }
  std::shift_right(result.start.begin(), result.start.end(), 1);
  result.start.front() = 0;
  std::vector<std::pair<std::uint32_t, float>> pairs;
  for (std::size_t row = 0; row < unknowns; ++row) {
    const std::size_t first = result.start[row], count = result.start[row + 1] - first;
    sort_row(std::span(result.column).subspan(first, count), std::span(result.G).subspan(first, count),
             pairs);
  }
  return result;
}

}  // namespace fluxel
