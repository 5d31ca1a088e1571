#include "metrics/field_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace fluxel {

namespace {

/// Keeps relMSE finite in black pixels, as is usual for pictures with a mean near 1.
constexpr double kDarkest = 0.01;

double square(double x) { return x * x; }
/// Of what may be below 0 in noise or rounding.
double root(double square) { return std::sqrt(std::max(square, 0.0)); }

/// The weighted mean of what `value` gives for each place of weight.
template <class Value>
double mean_of(std::span<const double> weights, const Value& value) {
  double sum = 0, weight = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] == 0) continue;
    sum += weights[i] * value(i);
    weight += weights[i];
  }
  return sum / weight;
}

/// The standard error of such a mean, where the values are independent and `variance` gives theirs.
template <class Variance>
double error_of_mean(std::span<const double> weights, const Variance& variance) {
  double sum = 0, weight = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    sum += square(weights[i]) * variance(i);
    weight += weights[i];
  }
  return root(sum) / weight;
}

/// A field without noise is its own two halves.
const Rgb& half_a(const Field& field, std::size_t i) {
  return field.has_noise() ? field.half_a[i] : field.values[i];
}
const Rgb& half_b(const Field& field, std::size_t i) {
  return field.has_noise() ? field.half_b[i] : field.values[i];
}

/// Square of the standard error.
double variance(const Field& field, std::size_t i, int c) {
  return field.has_noise() ? square(field.error[i][c]) : 0;
}

/// With A = D + B + a true difference D and independent noise of mean 0 in every half, (A_a - B_a)(A_b - B_b)
/// has the expectation D^2; so has the product with B's halves exchanged, and the mean of both varies less.
/// Where a half's noise has the variance v_A or v_B, twice the square of the standard error of the whole, the
/// variance of that mean is 2 u D^2 + (u^2 + v_A^2 + v_B^2) / 2 with u = v_A + v_B.
NoiseFreeErrors noise_free_errors(const Field& judged, const Field& reference,
                                  std::span<const double> weights, double bias, int c) {
  const auto product = [&](std::size_t i) {
    const double judged_a = half_a(judged, i)[c], judged_b = half_b(judged, i)[c];
    const double reference_a = half_a(reference, i)[c], reference_b = half_b(reference, i)[c];
    return ((judged_a - reference_a) * (judged_b - reference_b) +
            (judged_a - reference_b) * (judged_b - reference_a)) /
           2;
  };
  const auto product_variance = [&](std::size_t i) {
    const double of_judged = 2 * variance(judged, i, c), of_reference = 2 * variance(reference, i, c);
    const double of_both = of_judged + of_reference;
    return 2 * of_both * product(i) + (square(of_both) + square(of_judged) + square(of_reference)) / 2;
  };
  NoiseFreeErrors errors;
  errors.mean_square = mean_of(weights, product);
  errors.mean_square_error = error_of_mean(weights, product_variance);
  errors.bias_error = error_of_mean(
      weights, [&](std::size_t i) { return variance(judged, i, c) + variance(reference, i, c); });
  // The square of a bias with noise is too large by the noise's variance.
  errors.deviation_square = errors.mean_square - (square(bias) - square(errors.bias_error));
  errors.reference_noise =
      std::sqrt(mean_of(weights, [&](std::size_t i) { return variance(reference, i, c); }));
  errors.judged_noise = std::sqrt(mean_of(weights, [&](std::size_t i) { return variance(judged, i, c); }));
  return errors;
}

ColourErrors colour_errors(const Field& judged, const Field& reference, std::span<const double> weights,
                           int c) {
  const auto of_judged = [&](std::size_t i) { return judged.values[i][c]; };
  const auto of_reference = [&](std::size_t i) { return reference.values[i][c]; };
  const auto difference = [&](std::size_t i) { return of_judged(i) - of_reference(i); };
  ColourErrors errors;
  errors.mean = mean_of(weights, of_reference);
  errors.judged_mean = mean_of(weights, of_judged);
  errors.quadratic_mean = root(
      mean_of(weights, [&](std::size_t i) { return half_a(reference, i)[c] * half_b(reference, i)[c]; }));
  errors.bias = mean_of(weights, difference);
  errors.sigma = std::sqrt(mean_of(weights, [&](std::size_t i) { return square(difference(i)); }));
  errors.deviation =
      std::sqrt(mean_of(weights, [&](std::size_t i) { return square(difference(i) - errors.bias); }));
  errors.relative_mean_square = mean_of(
      weights, [&](std::size_t i) { return square(difference(i)) / (square(of_reference(i)) + kDarkest); });
  std::vector<double> distances(weights.size());
  for (std::size_t i = 0; i < weights.size(); ++i) distances[i] = std::abs(difference(i));
  errors.percentile_99 = weighted_percentile(distances, weights, 0.99);
  errors.largest = weighted_percentile(distances, weights, 1);
  if (judged.has_noise() || reference.has_noise())
    errors.noise_free = noise_free_errors(judged, reference, weights, errors.bias, c);
  return errors;
}

void require_fitting_sizes(const Field& judged, const Field& reference, std::span<const double> weights) {
  const auto fits = [&](const Field& field) {
    const auto one_each = [&](std::span<const Rgb> values) { return values.size() == weights.size(); };
    return one_each(field.values) &&
           (field.has_noise() ? one_each(field.error) && one_each(field.half_a) && one_each(field.half_b)
                              : field.half_a.empty() && field.half_b.empty());
  };
  if (!fits(judged) || !fits(reference)) throw std::logic_error("compare_fields: the sizes differ");
  if (std::ranges::none_of(weights, [](double weight) { return weight > 0; }))
    throw std::logic_error("compare_fields: nothing has a weight");
}

}  // namespace

double NoiseFreeErrors::sigma() const { return root(mean_square); }
double NoiseFreeErrors::sigma_low() const { return root(mean_square - mean_square_error); }
double NoiseFreeErrors::sigma_high() const { return root(std::max(mean_square, 0.0) + mean_square_error); }
double NoiseFreeErrors::deviation() const { return root(deviation_square); }

double ColourErrors::figure() const {
  const double error = noise_free ? noise_free->sigma() : sigma;
  return mean > 0 ? error / mean : std::numeric_limits<double>::infinity();
}

double ColourErrors::bound() const {
  return mean > 0 && noise_free && noise_free->is_hidden() ? noise_free->sigma_high() / mean : figure();
}

double FieldErrors::bound() const {
  double largest = 0;
  for (const auto& colour : colours)
    if (colour) largest = std::max(largest, colour->bound());
  return largest;
}

double FieldErrors::figure() const {
  double largest = 0;
  for (const auto& colour : colours)
    if (colour) largest = std::max(largest, colour->figure());
  return largest;
}

FieldErrors compare_fields(const Field& judged, const Field& reference, std::span<const double> weights) {
  require_fitting_sizes(judged, reference, weights);
  FieldErrors errors;
  for (int c = 0; c < kChannels; ++c) {
    bool dark = true;
    for (std::size_t i = 0; i < weights.size(); ++i)
      dark = dark && (weights[i] == 0 || (judged.values[i][c] == 0 && reference.values[i][c] == 0));
    if (!dark) errors.colours[static_cast<std::size_t>(c)] = colour_errors(judged, reference, weights, c);
  }
  return errors;
}

double weighted_percentile(std::span<const double> values, std::span<const double> weights, double share) {
  std::vector<std::size_t> order;
  double total = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (weights[i] == 0) continue;
    order.push_back(i);
    total += weights[i];
  }
  std::ranges::sort(order, {}, [&](std::size_t i) { return values[i]; });
  // From above, so that rounding of the sum never leaves the largest out.
  double above = 0;
  while (order.size() > 1) {
    above += weights[order.back()];
    if (above > (1 - share) * total) break;
    order.pop_back();
  }
  return values[order.back()];
}

}  // namespace fluxel
