#pragma once

#include <limits>
#include <span>

#include "core/progress.hpp"

namespace fluxel {

/// How a long phase stood at one moment.
struct PhaseSample {
  static constexpr double kUnknown = std::numeric_limits<double>::infinity();

  double seconds = 0;          ///< since the phase's start
  double done = 0;             ///< work, in a unit of the phase's own; what was restored counts
  double error = kUnknown;     ///< of accuracy-driven phases, in the target's unit
  double target = 0;           ///< of the error, as it is known at this moment
  double forecast = kUnknown;  ///< when the phase ends [s since its start]
};

/// The seconds since the phase's start at which `total` work will be done: the work that is left, at the pace
/// of the phase until now, in which that of its last half counts half. The time before the first sample
/// is start-up, as soon as there is a second one. `restored`: work that an earlier job has done, which took
/// no time here. Samples ascend; infinite where nothing is done yet.
[[nodiscard]] double forecast_by_work(std::span<const PhaseSample> samples, double total,
                                      double restored = 0);

/// The work at which the error comes to `target`, by a law fitted to the samples; infinite where it cannot be
/// told yet; a whole number of iterations. Of sampling the part a / done is that of A. Voloboy et al.,
/// eq. 10.
[[nodiscard]] double work_for_error(std::span<const PhaseSample> samples, ErrorLaw law, double target);

/// Both: the seconds since the phase's start at which the error has come to `target` and `closing` work,
/// which follows then, is done.
[[nodiscard]] double forecast_by_error(std::span<const PhaseSample> samples, ErrorLaw law, double target,
                                       double closing = 0, double restored = 0);

}  // namespace fluxel
