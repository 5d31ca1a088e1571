#include "metrics/known_error.hpp"

#include <algorithm>
#include <cmath>

namespace fluxel {

namespace {

/// What is expected is right within a factor of 1.5 in two of three random rooms (bench/calibration): the
/// standard error of its square over that.
constexpr double kSpread = 1.3;

/// Standard errors that nine of ten are below (Student 1908, 15 degrees of freedom).
constexpr double kNineOfTen = 1.341;

/// Standard errors by which what is measured may be above what is expected.
constexpr double kTooFarApart = 3;

double root_at_least_0(double square) { return std::sqrt(std::max(0.0, square)); }

/// A square that came out negative is 0, give or take its noise: below that nothing is stated.
KnownError interval_of(const MeasuredSquare& square) {
  return {root_at_least_0(square.value), root_at_least_0(square.value - kNineOfTen * square.error),
          std::sqrt(std::max(0.0, square.value) + kNineOfTen * square.error)};
}

}  // namespace

std::optional<KnownError> known_error(std::optional<double> expected,
                                      std::optional<MeasuredSquare> measured) {
  if (!expected && !measured) return std::nullopt;
  if (!expected) return interval_of(*measured);
  const MeasuredSquare by_rounds{*expected * *expected, kSpread * *expected * *expected};
  if (!measured) return interval_of(by_rounds);
  const double above = measured->value - by_rounds.value;
  if (!(measured->error > 0) || !(by_rounds.error > 0) ||
      above > kTooFarApart * std::hypot(measured->error, by_rounds.error))
    return interval_of(*measured);
  const double weight = 1 / (measured->error * measured->error),
               of_rounds = 1 / (by_rounds.error * by_rounds.error);
  return interval_of({(weight * measured->value + of_rounds * by_rounds.value) / (weight + of_rounds),
                      1 / std::sqrt(weight + of_rounds)});
}

std::optional<KnownError> larger(const std::optional<KnownError>& a, const std::optional<KnownError>& b) {
  if (!a || !b) return a ? a : b;
  return KnownError{std::max(a->likely, b->likely), std::max(a->least, b->least), std::max(a->most, b->most)};
}

double most_after_as_many_again(const KnownError& now) {
  return now.likely + (now.most - now.likely) / std::sqrt(2.0);
}

}  // namespace fluxel
