#pragma once

#include <array>
#include <optional>
#include <span>

#include "core/rgb.hpp"

namespace fluxel {

/// One quantity at elements or pixels, with what is known of its noise, or nothing of that: the standard
/// error of each value, and the means of two independent halves of the randomisations, whose mean is the
/// value.
struct Field {
  std::span<const Rgb> values{};
  std::span<const Rgb> error{}, half_a{}, half_b{};

  [[nodiscard]] bool has_noise() const { return !error.empty(); }
};

/// The error without the noise of the reference, and of the judged field where it has some. From products of
/// differences to independent halves, whose expectation is the square of the true difference, it has itself a
/// random error, and may come out below 0 where the true difference is far below the noise.
struct NoiseFreeErrors {
  double mean_square = 0;        ///< of the true difference; below 0 in noise
  double mean_square_error = 0;  ///< its standard error
  double bias_error = 0;         ///< standard error of ColourErrors::bias
  double deviation_square = 0;   ///< the mean square less that of the true bias; below 0 in noise
  double reference_noise = 0;    ///< root mean square of the reference's standard errors
  double judged_noise = 0;       ///< the same of the judged field; 0 where it has none

  /// Root mean square difference, 0 where noise hides it, and where one standard error takes it.
  [[nodiscard]] double sigma() const;
  [[nodiscard]] double sigma_low() const;
  [[nodiscard]] double sigma_high() const;
  /// Root mean square around the bias, 0 where noise hides it.
  [[nodiscard]] double deviation() const;
  /// Whether the noise alone could have made it.
  [[nodiscard]] bool is_hidden() const { return mean_square < mean_square_error; }
};

/// How far a judged field A is off a reference B in one colour, in the unit of the values, means being
/// weighted. Relative errors are those over `mean` or, always smaller, over `quadratic_mean`.
struct ColourErrors {
  double mean = 0;            ///< of B
  double quadratic_mean = 0;  ///< root mean square of B, of its halves' product where there are some
  double judged_mean = 0;     ///< of A
  double sigma = 0;           ///< root mean square of A - B, noise included
  double bias = 0;            ///< mean of A - B
  double deviation = 0;       ///< root mean square around the bias: sigma^2 = bias^2 + deviation^2
  double percentile_99 = 0;   ///< of |A - B|: no more than a hundredth of the weight is above, noise included
  double largest = 0;         ///< |A - B|
  double relative_mean_square = 0;  ///< mean of (A - B)^2 / (B^2 + 0.01), as pictures are judged by
  std::optional<NoiseFreeErrors> noise_free;

  /// Root mean square of A - B over the mean of B: without noise where that is known, else as it is. Infinite
  /// where B is dark and A is not.
  [[nodiscard]] double figure() const;
  /// The same; where noise hides the error, one standard error above it, which is all that is known.
  [[nodiscard]] double bound() const;
};

/// The errors of each colour; none where both fields are 0 everywhere.
struct FieldErrors {
  std::array<std::optional<ColourErrors>, kChannels> colours;

  /// The largest figure of the colours; 0 where there is none.
  [[nodiscard]] double figure() const;
  [[nodiscard]] double bound() const;
};

/// Compares A, which is judged, with B, the reference, `weights` (areas, or 1 a pixel) saying how much each
/// value counts; a weight of 0 leaves it out. The errors of different values are taken to be independent,
/// those of A and B too. Throws std::logic_error where the sizes do not fit each other or no weight is above
/// 0.
[[nodiscard]] FieldErrors compare_fields(const Field& judged, const Field& reference,
                                         std::span<const double> weights);

/// The least of the values that values of at least this share of the weight do not exceed.
[[nodiscard]] double weighted_percentile(std::span<const double> values, std::span<const double> weights,
                                         double share);

}  // namespace fluxel
