#pragma once

#include <array>
#include <span>
#include <vector>

#include "metrics/field_errors.hpp"

namespace fluxel {

/// A - B of each place and colour over the mean of B in that colour; 0 in colours that are left out or where
/// B is dark. Infinity is nowhere.
[[nodiscard]] std::vector<Rgb> relative_differences(const Field& judged, const Field& reference,
                                                    const FieldErrors& errors);

/// The same of all colours together, for a picture of one number a place: the sum of the colours' A - B over
/// the sum of their means of B.
[[nodiscard]] std::vector<double> overall_differences(const Field& judged, const Field& reference,
                                                      const FieldErrors& errors);

/// What a scale must reach, from -x to x, to show all but a hundredth of the weight: 1, 2 or 5 times a power
/// of ten, at least 1e-6.
[[nodiscard]] double symmetric_range(std::span<const double> values, std::span<const double> weights);

/// Bins of one width from -range to range, an odd number so that 0 lies in the middle of one, and one below
/// and one above all of them.
struct Histogram {
  static constexpr std::size_t kInside = 51;

  double range = 0;
  std::vector<Rgb> shares;  ///< of the weight, for each colour; kInside + 2

  /// Where a bin begins; -infinity for the first, infinity for the end of the last.
  [[nodiscard]] double begin(std::size_t bin) const;
};

[[nodiscard]] Histogram histogram_of(std::span<const Rgb> values, std::span<const double> weights,
                                     double range);

}  // namespace fluxel
