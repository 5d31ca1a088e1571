#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace fluxel {

/// What one correction adds to one row. A pair of unknowns has two of them, one a direction.
struct CorrectionEntry {
  std::uint32_t row = 0, column = 0;  ///< unknowns
  float G = 0;                        ///< [m2]
};

/// What is added to the exchange areas that the vector kernel makes from the bits, for the pairs that it gets
/// wrong: near ones and partly visible ones. Rows are unknowns (fronts, then backs), in compressed form.
/// Symmetric: a pair whose rows are both here stands in both.
struct Corrections {
  std::vector<std::uint64_t> start;   ///< unknowns + 1 entries, or none where nothing is corrected
  std::vector<std::uint32_t> column;  ///< ascending in a row
  std::vector<float> G;               ///< [m2] to add to G of the row and column

  [[nodiscard]] std::size_t bytes() const {
    return start.size() * sizeof(std::uint64_t) + column.size() * (sizeof(std::uint32_t) + sizeof(float));
  }
};

/// Entries as they are found, in parts: it grows without a second copy of what it has.
class CorrectionList {
 public:
  CorrectionList() = default;
  explicit CorrectionList(std::span<const CorrectionEntry> entries) { add(entries); }

  void add(std::span<const CorrectionEntry> entries);
  [[nodiscard]] std::size_t size() const;

  /// All that there is; nothing is left.
  [[nodiscard]] std::vector<std::vector<CorrectionEntry>> take() { return std::exchange(parts_, {}); }

 private:
  std::vector<std::vector<CorrectionEntry>> parts_;
};

/// Of an entry: in Corrections, and at most while it is found and compressed.
inline constexpr std::size_t kCorrectionBytes = sizeof(std::uint32_t) + sizeof(float);
inline constexpr std::size_t kFoundCorrectionBytes = sizeof(CorrectionEntry) + kCorrectionBytes;

/// The compressed form of entries, whatever order they come in; no two have one row and column. `unknowns`:
/// of the whole matrix.
[[nodiscard]] Corrections compress(CorrectionList entries, std::size_t unknowns);

/// How many pairs were looked at singly, and what that took.
struct CorrectionCounts {
  std::uint64_t near_pairs = 0;     ///< form factor by contour (or by points)
  std::uint64_t partial_pairs = 0;  ///< neither wholly hidden nor wholly visible
  std::uint64_t clipped_pairs = 0;  ///< visible part by the shadows of a few occluders, without rays
  std::uint64_t rays = 0;

  CorrectionCounts& operator+=(const CorrectionCounts& other) {
    near_pairs += other.near_pairs;
    partial_pairs += other.partial_pairs;
    clipped_pairs += other.clipped_pairs;
    rays += other.rays;
    return *this;
  }
};

}  // namespace fluxel
