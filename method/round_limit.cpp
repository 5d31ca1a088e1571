#include "method/round_limit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/options.hpp"
#include "core/signals.hpp"

namespace fluxel {

namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

}  // namespace

RoundLimit::RoundLimit(const Problem& problem, std::optional<double> limit, double points)
    : problem_(problem),
      limit_(limit),
      clock_(problem.world, problem.start),
      points_(points),
      refinement_end_(limit.value_or(kNoLimit)) {}

void RoundLimit::add(const RoundSample& round, double refine_seconds) {
  rounds_.push_back(round);
  problem_.world.all_max(std::span(&rounds_.back().bytes, 1));
  after_refinement_ = round.seconds - refine_seconds;
}

double RoundLimit::audit_seconds(double work) const {
  return problem_.options.audit / (1 - problem_.options.audit) * work;
}

std::optional<RunLimit> RoundLimit::before_round(double block_error, double ray_error) {
  bool is_late = false;
  if (limit_ && !rounds_.empty()) {
    const double next = forecast_round(rounds_, block_error).seconds;
    const double work = seconds() + next;
    const double closing = audit_seconds(work) + picture_seconds(ray_error);
    is_late = work + closing > *limit_;
    refinement_end_ = *limit_ - closing - after_refinement_ * next / rounds_.back().seconds;
  }
  std::array<std::uint64_t, 2> asked{end_requested() ? 1u : 0u,
                                     problem_.world.is_root() && is_late ? 1u : 0u};
  problem_.world.all_sum(asked);
  if (asked[0] > 0) return RunLimit::signal;
  return asked[1] > 0 ? std::optional(RunLimit::time) : std::nullopt;
}

bool RoundLimit::is_time_to_end() const { return end_requested() || clock_.own_seconds() > refinement_end_; }

RunLimit RoundLimit::reason() const {
  std::array<std::uint64_t, 2> asked{end_requested() ? 1u : 0u, is_time_to_end() ? 1u : 0u};
  problem_.world.all_sum(asked);
  if (asked[0] > 0) return RunLimit::signal;
  return asked[1] > 0 ? RunLimit::time : RunLimit::memory;
}

double RoundLimit::affordable_ray_error(double wanted) const {
  constexpr double kCoarsest = 4;
  const double picture = picture_seconds(wanted);
  const double left = limit_.value_or(kNoLimit) - seconds();
  if (picture <= left) return wanted;
  return wanted * (left > 0 ? std::min(picture / left, kCoarsest) : kCoarsest);
}

bool RoundLimit::has_time_for(double points, double ray_error) const {
  return seconds_before_picture(ray_error) > points / points_ * picture_seconds(ray_error);
}

double RoundLimit::seconds_before_picture(double ray_error) const {
  std::uint64_t asked = end_requested() ? 1 : 0;
  problem_.world.all_sum(std::span(&asked, 1));
  if (asked > 0) return 0;
  if (!limit_) return kNoLimit;
  return *limit_ - seconds() - picture_seconds(ray_error);
}

}  // namespace fluxel
