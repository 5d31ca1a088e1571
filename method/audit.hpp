#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/audit_paths.hpp"
#include "core/rgb.hpp"
#include "method/audit_places.hpp"
#include "method/problem.hpp"
#include "metrics/known_error.hpp"
#include "reference/finished_light.hpp"

namespace fluxel {

/// Over some places: how far what is stated is off what was measured.
struct AuditedMean {
  std::string name;
  double share = 1;  ///< of the places
  double mean = 0;   ///< that was measured [W/m2]
  double bias = 0;   ///< stated less measured, over the mean; see AuditGoal::faint
  double error = 0;  ///< standard error of the bias
};

/// A root mean square without the noise of what was measured, with its 95 % interval; noise may hide it,
/// which then is 0.
struct AuditedRms {
  double value = 0, low = 0, high = 0;
};

/// What a solution states of each place that is audited [W/m2].
struct StatedLight {
  std::vector<Rgb> B;
  /// The part of B that is taken from the solution, where the scale of that may be set by what is measured;
  /// else empty.
  std::vector<Rgb> of_solution;
  Rgb noise{0};  ///< mean square of what B has of noise of the rays that it was gathered by [W2/m4]
};

/// What an audit lets say of a target error.
enum class AuditVerdict {
  /// The intervals of the bias of the whole and of the root mean square bias of the parts lie within it, and
  /// nothing contradicts it.
  confirmed,
  /// The bias of the whole or of a part, or the root mean square of the places, is above: of all together
  /// wrong in one run of twenty.
  contradicted,
  undecided  ///< the intervals are too wide
};

inline const std::map<std::string, AuditVerdict> kAuditVerdictNames{
    {"confirmed", AuditVerdict::confirmed},
    {"contradicted", AuditVerdict::contradicted},
    {"undecided", AuditVerdict::undecided}};

/// A solution's error as paths of light have measured it, apart from the run's own estimate.
struct Audit {
  std::size_t places = 0;
  std::uint64_t paths = 0;                   ///< of all places, with those of earlier rounds
  std::uint64_t rays = 0;                    ///< likewise
  double seconds = 0;                        ///< likewise
  double width = 0;                          ///< of 95 % intervals, to each side [standard errors]
  std::array<AuditedMean, kChannels> whole;  ///< of each colour
  std::vector<AuditedMean> parts;            ///< of the mean of the colours
  AuditedRms of_places;    ///< radiosity of places, over the mean of all, in the colour where that is largest
  AuditedRms of_parts;     ///< biases of the parts
  KnownError of_solution;  ///< of_places, with what was expected of it, without the noise of rays
  KnownError known;        ///< likewise of what is shown, with its noise
  /// By which what is taken from the solution is multiplied, in what is compared and wherever it is shown: a
  /// colour whose bias is certain has none then but for the noise of the paths.
  Rgb scale{1};
  std::optional<AuditVerdict> verdict;  ///< where there is a target

  /// What is certain of the bias of the whole, in the colour where that is most; below 0 where it may be
  /// none.
  [[nodiscard]] double certain_of_whole() const;
  /// The bias of the whole or of a part that is certain to be the largest.
  [[nodiscard]] const AuditedMean& worst() const;
  /// The largest error that is certain, of any that a target error is compared with.
  [[nodiscard]] double certain() const;
  /// The most likely size of the largest bias, of those that noise does not hide.
  [[nodiscard]] double likely_bias() const;
  /// The largest bias of the whole that the paths would not have seen.
  [[nodiscard]] double resolution() const;
  /// The error that may be stated: what is known of it, and no less than what is certain of biases, or than
  /// what could be seen of them.
  [[nodiscard]] double stated() const;
};

struct AuditGoal {
  double target = 0;               ///< 0: there is none
  std::optional<double> expected;  ///< what is expected of the root mean square of the places, without noise
  double noise = 0;                ///< of rays, in what is shown: root mean square over the mean
  double faint = 1;  ///< a part that is darker counts as if it had this much of the whole's mean
  double rays = 0;   ///< that are spent in any case; one path of each randomisation is the least
  double limit = 0;  ///< of the rays where the error is not known well enough yet
  /// Of another round of the solution, in rays that take as long: where fewer are not foreseen to tell that
  /// the error is at most the target, that is the shorter way. Infinite where there is no other round.
  double round = std::numeric_limits<double>::infinity();
  /// Of the run after it, in rays that take as long, where so much is certain of `of_solution`: known better,
  /// it may save more than it takes. Unset: it saves nothing.
  std::function<double(double)> work_left;
  /// What it may take [s]: no more paths are begun that would foreseeably take longer; the least are traced.
  double seconds = std::numeric_limits<double>::infinity();
};

/// Of a run whose work takes as long as so many rays of paths.
[[nodiscard]] AuditGoal audit_goal(const Options& options, double work, double target,
                                   std::optional<double> expected);

/// Collective: measures the radiosity at the places by paths, with `solution` where Russian roulette ends
/// them, and compares what is `stated`, an entry a place. Goes on with the `paths` that have been traced from
/// these places, none at first. The scale of what is taken from the solution is
/// that by which the means are the same: a ratio estimate with the solution as the known variable (Cochran
/// 1977, chapter 6). All is the same on all ranks, as the result is.
[[nodiscard]] Audit audit(const Problem& problem, const AuditSubject& subject, const StatedLight& stated,
                          const FinishedLight& solution, const AuditGoal& goal, AuditPaths& paths);

/// For the terminal: what was measured.
[[nodiscard]] std::string audit_sentence(const Audit& found);

}  // namespace fluxel
