#pragma once

#include <optional>
#include <span>
#include <vector>

#include "method/problem.hpp"
#include "method/run_limit.hpp"
#include "metrics/round_forecast.hpp"
#include "mpi_master/communication/root_clock.hpp"

namespace fluxel {

/// Keeps rounds of refinement and solution within --time, and ends them after SIGINT or SIGTERM (see
/// EndCatcher), so that there is time for the picture. By the root's clock: all ranks decide alike.
class RoundLimit {
 public:
  /// `limit`: of the time since the run began [s]; unset: there is none. `points`: as many, gathered one by
  /// one, take as long as the picture in the end. The problem must outlive this.
  RoundLimit(const Problem& problem, std::optional<double> limit, double points);

  /// Collective: since the run began [s].
  [[nodiscard]] double seconds() const { return clock_.seconds(); }

  /// Collective: a round is finished, with these bytes of this rank; this went into the refinement [s].
  void add(const RoundSample& round, double refine_seconds);
  /// To gather light at a point, with rays of this error, took so long.
  void add_gather(double ray_error, double seconds) { gather_work_ = seconds * ray_error; }

  [[nodiscard]] std::span<const RoundSample> rounds() const { return rounds_; }
  /// What a picture takes whose rays have this error, at the pace of the last light that was gathered [s].
  /// Some of the time of a point does not depend on its rays; of the rest the square of their error would
  /// tell.
  [[nodiscard]] double picture_seconds(double ray_error) const { return points_ * gather_work_ / ray_error; }
  /// The share of the audit after so much work [s].
  [[nodiscard]] double audit_seconds(double work) const;

  /// Collective: what does not let a round with this block error begin, as it would foreseeably end, with the
  /// audit and a picture of rays of this error, after the limit. The first round begins in any case.
  [[nodiscard]] std::optional<RunLimit> before_round(double block_error, double ray_error);
  /// By this rank alone, and cheap: whether the refinement that is under way is to end.
  [[nodiscard]] bool is_time_to_end() const;
  /// Collective: of a refinement that has ended early.
  [[nodiscard]] RunLimit reason() const;

  /// Collective: the error that rays of the picture have to have at least for it to be ready in time.
  [[nodiscard]] double affordable_ray_error(double wanted) const;
  /// Collective: what is left before a picture of rays of this error [s]: infinite without a limit, 0 after a
  /// signal.
  [[nodiscard]] double seconds_before_picture(double ray_error) const;
  /// Collective: whether there is time to gather light at so many points, and then the picture.
  [[nodiscard]] bool has_time_for(double points, double ray_error) const;

 private:
  const Problem& problem_;
  std::optional<double> limit_;  // [s]
  RootClock clock_;
  double points_;
  std::vector<RoundSample> rounds_;
  double after_refinement_ = 0;  // of the last round [s]
  double refinement_end_;        // by the clock: what the refinement under way may take [s]
  double gather_work_ = 0;       // of a point: seconds times the error of the rays
};

}  // namespace fluxel
