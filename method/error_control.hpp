#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "hierarchy/hierarchy.hpp"
#include "method/audit.hpp"
#include "method/error_goal.hpp"
#include "method/hierarchy_statistics.hpp"
#include "method/problem.hpp"
#include "method/round_limit.hpp"
#include "method/round_preview.hpp"
#include "method/round_samples.hpp"
#include "mpi_master/checkpoint/round_folder.hpp"

namespace fluxel {

/// What looks after the rounds.
struct RoundCare {
  RoundFolder* folder;    ///< keeps each of them; null: nothing does
  RoundLimit& limit;      ///< ends them early
  RoundPreview* preview;  ///< shows those that it is asked for; null: nothing does
};

struct ControlledError {
  HierarchyStatistics statistics;
  std::optional<Audit> audit;  ///< of the last round
  ProbedLight probed;          ///< none without probes
};

/// Collective: refines and solves in turn, from coarse to fine, until the estimated error is the target's or
/// the memory or the time is used up; then its error is measured at the subject's places, and where that
/// contradicts the target refined once more. `probes` are points at whose radiosity the error is looked at;
/// none: it is looked at everywhere. Every whole round is kept in the folder, from where --resume goes on.
[[nodiscard]] ControlledError control_error(const Problem& problem, Hierarchy& hierarchy,
                                            std::span<const GatherPoint> probes, const AuditSubject& subject,
                                            const ErrorGoal& goal, const RoundCare& care);

/// The first rounds of a run, and what would follow.
struct TriedRounds {
  HierarchyStatistics statistics;
  /// Of the rounds that would follow if each left what its block error lets expect; none where the memory has
  /// ended them.
  std::vector<double> block_errors;
};

/// Collective: refines and solves in turn as control_error does, this many rounds at most, without measuring
/// what comes out; the rays of a picture are settled.
[[nodiscard]] TriedRounds try_rounds(const Problem& problem, Hierarchy& hierarchy,
                                     std::span<const GatherPoint> probes, const ErrorGoal& goal,
                                     RoundLimit& limit, std::size_t rounds);

}  // namespace fluxel
