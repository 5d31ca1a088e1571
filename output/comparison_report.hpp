#pragma once

#include <array>
#include <string>
#include <vector>

#include "metrics/signed_errors.hpp"
#include "output/comparands.hpp"

namespace fluxel {

struct CompareOptions;

inline constexpr const char* kColourNames[kChannels] = {"red", "green", "blue"};

/// What a comparison has found.
struct ComparisonReport {
  FieldErrors errors;
  std::vector<Rgb> relative;    ///< signed relative differences: see relative_differences
  std::vector<double> overall;  ///< the same of all colours together
  double range = 0;             ///< of the false colours, from -range to range
  Histogram histogram;

  /// Whether the main figure is without the reference's noise.
  [[nodiscard]] bool noise_free() const;
};

[[nodiscard]] ComparisonReport compare(const Comparands& of);

/// Sentences on what the figures do not say by themselves.
[[nodiscard]] std::vector<std::string> comparison_notes(const ComparisonReport& report);

/// The table that is printed.
[[nodiscard]] std::string comparison_table(const CompareOptions& options, const Comparands& of,
                                           const ComparisonReport& report);

/// Names of all files that a comparison may write or remove.
inline constexpr std::array kComparisonFiles{"compare.json", "compare.html", "histogram.csv",
                                             "error.exr",    "error.png",    "error.ply"};

/// Writes compare.json, compare.html, histogram.csv and the map of the error, and removes the map of the
/// other kind that an earlier comparison has left. Throws InputError where they cannot be written.
void write_comparison(const CompareOptions& options, const Comparands& of, const ComparisonReport& report);

}  // namespace fluxel
