#include "metrics/audit_statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <vector>

namespace fluxel {

namespace {

/// Of several values of one thing.
struct Sums {
  double sum = 0, squares = 0;
};

Sums sums_of(std::span<const double> values) {
  Sums sums;
  for (const double value : values) {
    sums.sum += value;
    sums.squares += value * value;
  }
  return sums;
}

/// The mean of all products of two different ones of n values.
double mean_product(const Sums& sums, double n) {
  return (sums.sum * sums.sum - sums.squares) / (n * (n - 1));
}

std::span<const double> of_place(const AuditSamples& samples, std::size_t place) {
  return samples.differences.subspan(place * samples.randomisations, samples.randomisations);
}

double positive_root(double square) { return std::sqrt(std::max(0.0, square)); }

}  // namespace

AuditedValue audited_bias(const AuditSamples& samples, std::span<const std::uint32_t> places) {
  const auto n = static_cast<double>(samples.randomisations);
  const auto count = static_cast<double>(places.size());
  std::vector<double> means(samples.randomisations);
  double mean_square = 0;
  for (const std::uint32_t place : places) {
    const std::span<const double> differences = of_place(samples, place);
    for (std::size_t r = 0; r < means.size(); ++r) means[r] += differences[r] / count;
    mean_square += mean_product(sums_of(differences), n) / count;
  }
  const Sums sums = sums_of(means);
  const double bias = sums.sum / n;
  return {bias, positive_root((sums.squares - n * bias * bias) / (n * (n - 1))),
          positive_root((mean_square - mean_product(sums, n)) / count)};
}

AuditedValue audited_square(const AuditSamples& samples) {
  const auto n = static_cast<double>(samples.randomisations);
  const auto count = static_cast<double>(samples.places());
  std::vector<double> without(samples.randomisations);  // the mean product, one randomisation left out
  Sums products;
  for (std::size_t place = 0; place < samples.places(); ++place) {
    const std::span<const double> differences = of_place(samples, place);
    const Sums all = sums_of(differences);
    const double product = mean_product(all, n);
    products.sum += product;
    products.squares += product * product;
    for (std::size_t r = 0; r < without.size(); ++r) {
      const double out = differences[r];
      without[r] += mean_product({all.sum - out, all.squares - out * out}, n - 1) / count;
    }
  }
  const double mean = products.sum / count;
  double jackknife = 0;
  for (const double one : without) jackknife += (one - mean) * (one - mean);
  jackknife *= (n - 1) / n;
  // The spread between places has the noise of their own paths in it.
  const double between = (products.squares / count - mean * mean) / count;
  return {mean, positive_root(jackknife), positive_root(between - jackknife)};
}

double interval_width(double chance, std::size_t intervals, std::size_t randomisations) {
  const boost::math::students_t distribution(static_cast<double>(randomisations - 1));
  const double outside = (1 - chance) / static_cast<double>(intervals);
  return boost::math::quantile(boost::math::complement(distribution, outside / 2));
}

}  // namespace fluxel
