#pragma once

#include <optional>

namespace fluxel {

/// A root mean square error over the mean, as far as it is known.
struct KnownError {
  double likely = 0;
  /// With a chance of 90 % it is at least, and with one of 90 % at most, this.
  double least = 0, most = 0;
};

/// The square of such an error as it was measured, which noise may have made negative.
struct MeasuredSquare {
  double value = 0;
  double error = 0;  ///< standard error
};

/// From what a run's own rounds let expect of the error, and from what was measured whatever they say: the
/// mean of both squares weighted by the inverse of their variances. Where what was measured is further
/// above than chance explains it counts alone. One of them may be missing; without both nothing is known.
[[nodiscard]] std::optional<KnownError> known_error(std::optional<double> expected,
                                                    std::optional<MeasuredSquare> measured);

/// Of several kinds of one error, as of colours, what is known of the largest: the larger of each number.
[[nodiscard]] std::optional<KnownError> larger(const std::optional<KnownError>& a,
                                               const std::optional<KnownError>& b);

/// What the error would be at most, by the same chance, after as many measurements again that agree with
/// these.
[[nodiscard]] double most_after_as_many_again(const KnownError& now);

}  // namespace fluxel
