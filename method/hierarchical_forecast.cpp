// What solve_hierarchical would take.

#include <fmt/format.h>

#include <string>
#include <utility>

#include "core/options.hpp"
#include "method/element_light.hpp"
#include "method/error_control.hpp"
#include "method/methods.hpp"
#include "method/seen_hierarchy.hpp"
#include "method/subdivide.hpp"

namespace fluxel {

namespace {

/// The first tells of no error, and of two together how links and time grow.
constexpr std::size_t kTriedRounds = 2;

std::string in_gib(double bytes) { return fmt::format("{:.3g} GiB on the largest rank", bytes * 0x1p-30); }

void say_round(Log& log, std::size_t number, const HierarchyRound& round, const RoundSample& sample) {
  log.say(fmt::format("round {}: {}, {} leaves, {}; {}, {:.2f} s", number, exchange_text(round), round.leaves,
                      round.discretisation ? fmt::format("error about {:.2g} %", 100 * *round.discretisation)
                                           : "error not known yet",
                      in_gib(sample.bytes), sample.seconds));
}

HierarchyForecast forecast_of(const RoundLimit& limit, const TriedRounds& tried) {
  HierarchyForecast forecast;
  forecast.rounds = tried.block_errors.size();
  forecast.last = forecast_rounds(limit.rounds(), tried.block_errors);
  double work = forecast.last.seconds;
  for (const RoundSample& round : limit.rounds()) work += round.seconds;
  forecast.audit_seconds = limit.audit_seconds(work);
  forecast.picture_seconds = limit.picture_seconds(tried.statistics.ray_error);
  return forecast;
}

void say_forecast(const Problem& problem, const ErrorGoal& goal, const HierarchyStatistics& statistics) {
  const HierarchyForecast& forecast = *statistics.forecast;
  problem.log.say(fmt::format(
      "forecast: {} more round{} to {}, about {:.2g} {} in the end, {}; rounds {:.1f} s, audit {:.1f} s, "
      "picture "
      "{:.1f} s",
      forecast.rounds, forecast.rounds == 1 ? "" : "s",
      goal.target > 0 ? fmt::format("the target of {:.2g} %", 100 * goal.target)
                      : fmt::format("a block error of {:.2g}", goal.block_error),
      forecast.last.links, statistics.by_rays ? "rows of rays" : "links", in_gib(forecast.last.bytes),
      forecast.last.seconds, forecast.audit_seconds, forecast.picture_seconds));
  if (statistics.ended_by || forecast.last.bytes > static_cast<double>(goal.bytes))
    problem.log.warn(fmt::format(
        "the run would not fit in the {:.3g} GiB that a rank may take: it would be as fine as they allow",
        static_cast<double>(goal.bytes) * 0x1p-30));
}

}  // namespace

Solution forecast_hierarchical(const Problem& problem) {
  Solution solution;
  subdivide(problem, {}, solution);
  Stopwatch watch;
  const SeenHierarchy seen = see_hierarchy(problem, solution.subdivided.raster);
  const double picture = work_of_picture(problem.options, seen);
  const ErrorGoal goal = goal_of(problem, picture);
  RoundLimit limit(problem, std::nullopt, picture);
  TriedRounds tried = try_rounds(problem, *seen.hierarchy, seen.probes, goal, limit, kTriedRounds);
  tried.statistics.by_rays = seen.by_rays;
  tried.statistics.forecast = forecast_of(limit, tried);
  for (std::size_t k = 0; k < tried.statistics.rounds.size(); ++k)
    say_round(problem.log, k + 1, tried.statistics.rounds[k], limit.rounds()[k]);
  say_forecast(problem, goal, tried.statistics);
  sum_counts(problem.world, *seen.hierarchy, tried.statistics);
  solution.hierarchy = std::move(tried.statistics);
  if (problem.options.subdivision == Subdivision::transport)
    take_leaves(problem.world, seen.hierarchy->tree(), seen.points, solution.subdivided);
  solution.time.forecast = watch.lap();
  solution.end = RunEnd::forecast;
  return solution;
}

}  // namespace fluxel
