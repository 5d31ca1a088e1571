#include "metrics/forecast.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fluxel {

namespace {

constexpr double kLeastExponent = 0.4, kMostExponent = 1.6, kMonteCarlo = 0.5;
/// Work before this part of all that is done is start-up, where errors follow no law yet.
constexpr double kStartUp = 0.01;
/// What the exponent is fitted to: points whose work differs by this factor at least, over this range.
constexpr double kPointRatio = 1.15, kLeastRange = 4;
constexpr std::size_t kLeastPoints = 5;
/// An exponent is not that of Monte Carlo where it differs by so many standard errors.
constexpr double kStandardErrors = 2;
/// The iterations from which the rate of a geometric fall is taken.
constexpr std::size_t kLeastIterations = 3;
/// Of an iteration: what rounding may make of a whole number of them.
constexpr double kRounding = 1e-6;

struct Point {
  double x, y;
};

/// y = level + slope (x - centre).
struct Line {
  double centre, level, slope, slope_error;
};

/// Least squares; needs two different x. The slope's error is that of independent noise.
Line fit_line(std::span<const Point> points) {
  Line line{};
  const auto count = static_cast<double>(points.size());
  for (const Point& point : points) {
    line.centre += point.x / count;
    line.level += point.y / count;
  }
  double xx = 0, xy = 0, noise = 0;
  for (const Point& point : points) {
    xx += (point.x - line.centre) * (point.x - line.centre);
    xy += (point.x - line.centre) * (point.y - line.level);
  }
  line.slope = xy / xx;
  for (const Point& point : points)
    noise += std::pow(point.y - line.level - line.slope * (point.x - line.centre), 2);
  line.slope_error = points.size() > 2 ? std::sqrt(noise / (count - 2) / xx) : PhaseSample::kUnknown;
  return line;
}

bool has_error(const PhaseSample& sample) {
  return sample.done > 0 && sample.error > 0 && std::isfinite(sample.error);
}

/// log error against log done, at most one point for each factor kPointRatio of work. A sum's noise stays in
/// it when it grows, so that more points would say nothing more.
std::vector<Point> spread_points(std::span<const PhaseSample> samples) {
  std::vector<Point> points;
  double next = PhaseSample::kUnknown;
  for (auto sample = samples.rbegin(); sample != samples.rend(); ++sample) {
    if (!has_error(*sample) || sample->done > next || sample->done < kStartUp * samples.back().done) continue;
    points.push_back({std::log(sample->done), std::log(sample->error)});
    next = sample->done / kPointRatio;
  }
  return points;
}

double exponent_of(std::span<const PhaseSample> samples) {
  const std::vector<Point> points = spread_points(samples);
  if (points.size() < kLeastPoints) return kMonteCarlo;
  const double range = points.front().x - points.back().x;
  if (range < std::log(kLeastRange)) return kMonteCarlo;
  const Line line = fit_line(points);
  // A doubling of the work brings as much new as all before: so many points are independent.
  const double independent = range / std::log(2.0);
  const double inflation = std::sqrt(std::max(1.0, static_cast<double>(points.size()) / independent));
  const double doubt = kStandardErrors * inflation * line.slope_error;
  const double beyond = -line.slope - kMonteCarlo;
  const double believed = std::copysign(std::max(0.0, std::abs(beyond) - doubt), beyond);
  return std::clamp(kMonteCarlo + believed, kLeastExponent, kMostExponent);
}

double work_by_power(std::span<const PhaseSample> samples, double target) {
  const double exponent = exponent_of(samples);
  // The level comes from the last half of the work, which holds most of what is known.
  double sum = 0;
  int count = 0;
  for (const PhaseSample& sample : samples) {
    if (!has_error(sample) || sample.done < 0.5 * samples.back().done) continue;
    sum += std::log(sample.error) + exponent * std::log(sample.done);
    ++count;
  }
  if (count == 0) return PhaseSample::kUnknown;
  return std::exp((sum / count - std::log(target)) / exponent);
}

double work_by_iterations(std::span<const PhaseSample> samples, double target) {
  std::vector<Point> points;
  for (const PhaseSample& sample : samples)
    if (has_error(sample)) points.push_back({sample.done, std::log(sample.error)});
  if (points.size() < 2) return PhaseSample::kUnknown;
  // The rate changes on the way: the first iterations are the quickest.
  const std::size_t recent = std::max(kLeastIterations, (points.size() + 1) / 2);
  const Line line = fit_line(std::span(points).last(std::min(recent, points.size())));
  if (!(line.slope < 0)) return PhaseSample::kUnknown;
  return std::ceil(line.centre + (std::log(target) - line.level) / line.slope - kRounding);
}

}  // namespace

double forecast_by_work(std::span<const PhaseSample> samples, double total, double restored) {
  if (samples.empty()) return PhaseSample::kUnknown;
  const PhaseSample& last = samples.back();
  if (last.done >= total) return last.seconds;
  const PhaseSample start{0, restored};
  const PhaseSample& first = samples.size() > 1 && last.done > samples.front().done ? samples.front() : start;
  const auto middle =
      std::ranges::lower_bound(samples, 0.5 * (first.seconds + last.seconds), {}, &PhaseSample::seconds);
  const auto seconds_a_unit = [&](const PhaseSample& since) {
    return (last.seconds - since.seconds) / (last.done - since.done);
  };
  if (!(last.done > first.done)) return PhaseSample::kUnknown;
  const double whole = seconds_a_unit(first);
  const double recent = middle->done < last.done ? seconds_a_unit(*middle) : whole;
  return last.seconds + (total - last.done) * 0.5 * (whole + recent);
}

double work_for_error(std::span<const PhaseSample> samples, ErrorLaw law, double target) {
  if (samples.empty() || !(target > 0)) return PhaseSample::kUnknown;
  const PhaseSample& last = samples.back();
  if (last.error <= target) return last.done;
  const double work =
      law == ErrorLaw::power ? work_by_power(samples, target) : work_by_iterations(samples, target);
  // The mean of noisy errors may have come there when the last has not.
  return std::max(work, last.done);
}

double forecast_by_error(std::span<const PhaseSample> samples, ErrorLaw law, double target, double closing,
                         double restored) {
  const double work = work_for_error(samples, law, target);
  if (!std::isfinite(work)) return PhaseSample::kUnknown;
  return forecast_by_work(samples, work + closing, restored);
}

}  // namespace fluxel
