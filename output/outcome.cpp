#include "output/outcome.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/options.hpp"

namespace fluxel {

std::string unreached(const RunRecord& record) {
  const Solution& solution = record.solution;
  if (!solution.converged) return "the solver has not converged";
  if (solution.stopped) return "a signal has ended the run before all was done";
  if (solution.goal_reached) return "";
  const auto missed = std::ranges::find_if(solution.sensors,
                                           [](const SensorLight& light) { return !light.measured.reached; });
  const bool picture_is_good =
      !solution.stated_error || *solution.stated_error <= record.options.target_error.value_or(kTargetError);
  if (missed != solution.sensors.end() && picture_is_good)
    return missed->name() + ": " + unreached(missed->measured);
  return "the error that was asked for was not reached" +
         (solution.stated_error ? fmt::format(": {:.2g} % is stated", 100 * *solution.stated_error)
                                : std::string());
}

std::string unreached(const ReferenceResult& measured) {
  if (measured.reached) return "";
  if (measured.partly_before)
    return "not all photons have gone again after the change: a part of the light is that of the scene "
           "before";
  const Rgb& error = measured.relative_error;
  const double largest = std::max({error.r, error.g, error.b});
  if (!std::isfinite(largest)) return "no path has found light, and how much there is is not known";
  return fmt::format("the error that was asked for was not reached: {:.2g} % of the mean", 100 * largest);
}

}  // namespace fluxel
