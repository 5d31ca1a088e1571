#include "metrics/signed_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fluxel {

namespace {

/// The mean of B in a colour; 0 where nothing is relative to it.
double mean_in_colour(const FieldErrors& errors, int c) {
  const auto& colour = errors.colours[static_cast<std::size_t>(c)];
  return colour && colour->mean > 0 ? colour->mean : 0;
}

/// The nearest value that a file of single precision holds.
double in_single_precision(double value) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  return std::clamp(value, -kLargest, kLargest);
}

std::size_t bin_of(double value, double range) {
  const double width = 2 * range / static_cast<double>(Histogram::kInside);
  const double bin = std::floor((value + range) / width) + 1;
  return static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(Histogram::kInside + 1)));
}

}  // namespace

std::vector<Rgb> relative_differences(const Field& judged, const Field& reference,
                                      const FieldErrors& errors) {
  std::vector<Rgb> differences(judged.values.size(), Rgb(0));
  for (int c = 0; c < kChannels; ++c) {
    const double mean = mean_in_colour(errors, c);
    if (mean == 0) continue;
    for (std::size_t i = 0; i < differences.size(); ++i)
      differences[i][c] = in_single_precision((judged.values[i][c] - reference.values[i][c]) / mean);
  }
  return differences;
}

std::vector<double> overall_differences(const Field& judged, const Field& reference,
                                        const FieldErrors& errors) {
  double mean = 0;
  for (int c = 0; c < kChannels; ++c) mean += mean_in_colour(errors, c);
  std::vector<double> differences(judged.values.size(), 0.0);
  if (mean == 0) return differences;
  for (std::size_t i = 0; i < differences.size(); ++i) {
    const Rgb difference = judged.values[i] - reference.values[i];
    differences[i] = in_single_precision((difference.r + difference.g + difference.b) / mean);
  }
  return differences;
}

double symmetric_range(std::span<const double> values, std::span<const double> weights) {
  constexpr double kMin = 1e-6;
  std::vector<double> distances(values.begin(), values.end());
  for (double& distance : distances) distance = std::abs(distance);
  const double needed = std::max(kMin, weighted_percentile(distances, weights, 0.99));
  const double power = std::pow(10, std::floor(std::log10(needed)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= needed) return factor * power;
  return 10 * power;
}

double Histogram::begin(std::size_t bin) const {
  if (bin == 0) return -std::numeric_limits<double>::infinity();
  if (bin == kInside + 2) return std::numeric_limits<double>::infinity();
  return range * (2 * static_cast<double>(bin - 1) / static_cast<double>(kInside) - 1);
}

Histogram histogram_of(std::span<const Rgb> values, std::span<const double> weights, double range) {
  Histogram histogram{range, std::vector<Rgb>(Histogram::kInside + 2, Rgb(0))};
  double total = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    total += weights[i];
    for (int c = 0; c < kChannels; ++c) histogram.shares[bin_of(values[i][c], range)][c] += weights[i];
  }
  for (Rgb& share : histogram.shares) share /= total;
  return histogram;
}

}  // namespace fluxel
