#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/options.hpp"
#include "hierarchy/hierarchy.hpp"
#include "method/audit.hpp"
#include "method/hierarchy_statistics.hpp"
#include "method/problem.hpp"

namespace fluxel {

/// What a run with a hierarchy has come to when its error is to be measured.
struct AuditedRun {
  std::span<const HierarchyRound> rounds;
  std::size_t probes = 0;
  double target = 0;               ///< 0: there is none
  double ray_error = 0;            ///< of the picture's rays, and
  double noise = 0;                ///< what they make of it
  std::optional<double> expected;  ///< of the error, without noise where that is told apart
  bool tells_noise = false;
  bool may_go_on = false;  ///< another round may follow
  double points = 0;       ///< gathers at single points that take as long as the picture
  double seconds = 0;      ///< that measuring may take
  /// The noise that the picture may have in the end where so much is certain of the rest of its error.
  std::function<double(double)> allowed_noise;
};

/// Measures the error of a hierarchy's solution by paths of light from the places of a subject, and sets the
/// scale of what it reflects. Each measurement goes on with the paths of those before. Calls are collective.
class HierarchyAudit {
 public:
  /// What is referred to must outlive this.
  HierarchyAudit(const Problem& problem, Hierarchy& hierarchy, const AuditSubject& subject);

  /// Whether it is asked for, and there is something to measure.
  [[nodiscard]] bool can_measure() const { return problem_.options.audit > 0 && !places_.empty(); }
  /// What has been traced so far, to be kept with rounds and taken up.
  [[nodiscard]] AuditPaths& paths() { return paths_; }
  [[nodiscard]] Audit measure(const AuditedRun& run);

  /// The probes, without any all places, and the places of what is off in the stead of as many as it takes:
  /// the error that is let pass falls with the root of their number.
  [[nodiscard]] std::vector<GatherPoint> points_of_importance(std::span<const GatherPoint> probes,
                                                              const Audit& audit, double target) const;

 private:
  /// In rays of paths that take as long.
  struct Work {
    double rounds = 0, picture = 0, next_round = 0;
  };
  [[nodiscard]] Audit audit_by_solution(const StatedLight& stated, const AuditGoal& goal);
  [[nodiscard]] Work work_of(const AuditedRun& run, std::uint64_t gather_rays) const;
  [[nodiscard]] AuditGoal goal_of(const AuditedRun& run, std::uint64_t gather_rays) const;

  const Problem& problem_;
  Hierarchy& hierarchy_;
  const AuditSubject& subject_;
  std::vector<GatherPoint> places_;  // of the subject
  AuditPaths paths_;                 // of all audits so far
};

}  // namespace fluxel
