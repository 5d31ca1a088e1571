#include "metrics/forecast.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fluxel {

namespace {

/// The weight of the last half's pace beside that of all: a machine may have become slower or faster, but a
/// dear piece of work that comes last must not count for all that is left.
constexpr double kRecent = 0.5;

/// Work before this part of all that is done is start-up, where errors follow no law yet.
constexpr double kStartUp = 0.1;
/// Of a power law: errors of less than this part of the work say too little of how they fall at the end.
constexpr double kRecentPower = 0.25;
/// Powers between those of random numbers and of the smoothest integrands; before there is much to fit,
/// that of the ten runs in bench/results/photons.md, which counts as a fit over one e-fold of work does.
constexpr double kLeastPower = 0.5, kUsualPower = 0.54, kMostPower = 1;
constexpr double kUsualPowerWeight = 1;  // beside the sum of (ln work - mean)^2

/// The iterations from which the rate of a geometric fall is taken.
constexpr std::size_t kMinIterations = 3;
/// Of an iteration: what rounding may make of a whole number of them.
constexpr double kRounding = 1e-6;

struct Point {
  double x, y;
};

/// y = level + slope (x - centre).
struct Line {
  double centre, level, slope;
};

/// Least squares, beside a slope known beforehand that counts as `weight` of the sum of (x - centre)^2;
/// needs two different x or a weight.
Line fit_line(std::span<const Point> points, double known_slope = 0, double weight = 0) {
  Line line{};
  const auto count = static_cast<double>(points.size());
  for (const Point& point : points) {
    line.centre += point.x / count;
    line.level += point.y / count;
  }
  double xx = weight, xy = weight * known_slope;
  for (const Point& point : points) {
    xx += (point.x - line.centre) * (point.x - line.centre);
    xy += (point.x - line.centre) * (point.y - line.level);
  }
  line.slope = xy / xx;
  return line;
}

bool has_error(const PhaseSample& sample) {
  return sample.done > 0 && sample.error > 0 && std::isfinite(sample.error);
}

/// What a sampled mean's squared error is made of: noise / done + even / done^2.
struct SquaredError {
  double noise = 0, even = 0;
};

/// Least squares of the ratio of law and sample, neither part below 0.
SquaredError fit_squared_error(std::span<const PhaseSample> samples) {
  double xx = 0, xy = 0, yy = 0, x_sum = 0, y_sum = 0;
  for (const PhaseSample& sample : samples) {
    if (!has_error(sample) || sample.done < kStartUp * samples.back().done) continue;
    const double x = 1 / (sample.done * sample.error * sample.error), y = x / sample.done;
    xx += x * x, xy += x * y, yy += y * y, x_sum += x, y_sum += y;
  }
  if (!(xx > 0)) return {};
  const double determinant = xx * yy - xy * xy;
  constexpr double kSame = 1e-12;  // relative: one moment alone, or rounding of it
  if (!(determinant > kSame * xx * yy)) return {x_sum / xx, 0};
  const SquaredError both{(x_sum * yy - y_sum * xy) / determinant, (y_sum * xx - x_sum * xy) / determinant};
  if (both.even < 0) return {x_sum / xx, 0};
  if (both.noise < 0) return {0, y_sum / yy};
  return both;
}

double work_by_sampling(std::span<const PhaseSample> samples, double target) {
  const auto [noise, even] = fit_squared_error(samples);
  if (!(noise + even > 0)) return PhaseSample::kUnknown;
  const double square = target * target;
  return (noise + std::sqrt(noise * noise + 4 * square * even)) / (2 * square);
}

double work_by_power(std::span<const PhaseSample> samples, double target) {
  std::vector<Point> points;
  for (const PhaseSample& sample : samples)
    if (has_error(sample) && sample.done >= kRecentPower * samples.back().done)
      points.push_back({std::log(sample.done), std::log(sample.error)});
  if (points.empty()) return PhaseSample::kUnknown;
  const Line line = fit_line(points, -kUsualPower, kUsualPowerWeight);
  const double power = std::clamp(-line.slope, kLeastPower, kMostPower);
  return std::exp(line.centre + (line.level - std::log(target)) / power);
}

double work_by_iterations(std::span<const PhaseSample> samples, double target) {
  std::vector<Point> points;
  for (const PhaseSample& sample : samples)
    if (has_error(sample)) points.push_back({sample.done, std::log(sample.error)});
  if (points.size() < 2) return PhaseSample::kUnknown;
  // The rate changes on the way: the first iterations are the quickest.
  const std::size_t recent = std::max(kMinIterations, (points.size() + 1) / 2);
  const Line line = fit_line(std::span(points).last(std::min(recent, points.size())));
  if (!(line.slope < 0)) return PhaseSample::kUnknown;
  return std::ceil(line.centre + (std::log(target) - line.level) / line.slope - kRounding);
}

double work_by(ErrorLaw law, std::span<const PhaseSample> samples, double target) {
  switch (law) {
    case ErrorLaw::sampling:
      return work_by_sampling(samples, target);
    case ErrorLaw::power:
      return work_by_power(samples, target);
    case ErrorLaw::geometric:
      return work_by_iterations(samples, target);
  }
  return PhaseSample::kUnknown;
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
  return last.seconds + (total - last.done) * (whole + kRecent * (recent - whole));
}

double work_for_error(std::span<const PhaseSample> samples, ErrorLaw law, double target) {
  if (samples.empty() || !(target > 0)) return PhaseSample::kUnknown;
  const PhaseSample& last = samples.back();
  if (last.error <= target) return last.done;
  // The mean of noisy errors may have come there when the last has not.
  return std::max(work_by(law, samples, target), last.done);
}

double forecast_by_error(std::span<const PhaseSample> samples, ErrorLaw law, double target, double closing,
                         double restored) {
  const double work = work_for_error(samples, law, target);
  if (!std::isfinite(work)) return PhaseSample::kUnknown;
  return forecast_by_work(samples, work + closing, restored);
}

}  // namespace fluxel
