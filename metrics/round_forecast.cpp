#include "metrics/round_forecast.hpp"

#include <algorithm>
#include <cmath>

namespace fluxel {

namespace {

/// Of what grows from `before` to `now` while the block error falls by a factor of `step`: the power of it.
/// Small rounds take as long as they do for other reasons.
double power_of_growth(double before, double now, double step) {
  constexpr double kLeast = 0.5, kMost = 1.25;
  if (!(before > 0 && now > 0 && step > 1)) return 1;
  return std::clamp(std::log(now / before) / std::log(step), kLeast, kMost);
}

}  // namespace

double next_block_error(double block_error, double error, double target) {
  constexpr double kAim = 0.7, kMinStep = 3, kMaxStep = 8;
  // The error falls about as the root of what a link may leave.
  const double wanted = error / (kAim * target);
  return block_error / std::clamp(wanted * wanted, kMinStep, kMaxStep);
}

RoundSample forecast_round(std::span<const RoundSample> rounds, double block_error) {
  const RoundSample& last = rounds.back();
  const RoundSample& before = rounds[rounds.size() < 2 ? 0 : rounds.size() - 2];
  const double step = before.block_error / last.block_error;
  const auto grown = [&](double RoundSample::*quantity) {
    return last.*quantity *
           std::pow(last.block_error / block_error, power_of_growth(before.*quantity, last.*quantity, step));
  };
  return {block_error, grown(&RoundSample::links), grown(&RoundSample::bytes), grown(&RoundSample::seconds)};
}

RoundSample forecast_rounds(std::span<const RoundSample> rounds, std::span<const double> block_errors) {
  RoundSample last = rounds.back();
  last.seconds = 0;
  for (const double block_error : block_errors) {
    const double before = last.seconds;
    last = forecast_round(rounds, block_error);
    last.seconds += before;
  }
  return last;
}

}  // namespace fluxel
