#include "method/hierarchy_audit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "method/finished_cut.hpp"
#include "method/methods.hpp"
#include "method/relative_error.hpp"
#include "method/stated_light.hpp"

namespace fluxel {

HierarchyAudit::HierarchyAudit(const Problem& problem, Hierarchy& hierarchy, const AuditSubject& subject)
    : problem_(problem),
      hierarchy_(hierarchy),
      subject_(subject),
      places_(points_of(hierarchy.tree(), subject)) {}

Audit HierarchyAudit::measure(const AuditedRun& run) {
  const std::uint64_t rays_before = hierarchy_.gather_rays();
  StatedLight stated = reflected_at(hierarchy_, places_, subject_, run.ray_error);
  const std::uint64_t gather_rays = hierarchy_.gather_rays() - rays_before;
  if (!run.tells_noise) stated.noise = Rgb(0);
  if (run.probes > 0) {
    hierarchy_.scale_reflected(Rgb(0));
    const std::vector<Rgb> of_emitters =
        reflected_at(hierarchy_, places_, subject_, kForScale * run.ray_error).B;
    for (std::size_t k = 0; k < of_emitters.size(); ++k)
      stated.of_solution.push_back(stated.B[k] - of_emitters[k]);
  }
  add_emission(subject_, stated);
  Audit found = audit_by_solution(stated, goal_of(run, gather_rays));
  hierarchy_.scale_reflected(found.scale);
  return found;
}

Audit HierarchyAudit::audit_by_solution(const StatedLight& stated, const AuditGoal& goal) {
  if (const std::optional<CutLight> light = hierarchy_.cut_light())
    return audit(problem_, subject_, stated, FinishedCut(hierarchy_.tree(), *light), goal, paths_);
  const LeafLight light = hierarchy_.leaf_light();
  const LeafCut leaves(hierarchy_.tree(), light.leaves, light.radiosity.H, problem_.threads);
  return audit(problem_, subject_, stated, FinishedCut(hierarchy_.tree(), leaves.light()), goal, paths_);
}

/// What the run has done, in this process or an earlier one, and what the picture would take with these rays
/// and without a filter; fitted to runs of ten scenes. `gather_rays` are this rank's for all places.
HierarchyAudit::Work HierarchyAudit::work_of(const AuditedRun& run, std::uint64_t gather_rays) const {
  constexpr double kRefinementRay = 2, kGatherRay = 0.4, kLinkOfIteration = 0.5;
  std::array<std::uint64_t, 2> rays{hierarchy_.counts().rays, gather_rays};
  problem_.world.all_sum(rays);
  const double of_point = kGatherRay * static_cast<double>(rays[1]) / static_cast<double>(places_.size());
  double links = 0;
  for (const HierarchyRound& round : run.rounds)
    links += static_cast<double>(round.links) * static_cast<double>(round.iterations);
  // Each round has gathered at the probes, twice.
  const double refinement = kRefinementRay * static_cast<double>(rays[0]) + kLinkOfIteration * links;
  const double probing = 2 * static_cast<double>(run.probes) * of_point;
  // What finer rounds take.
  constexpr double kNextRefinement = 2;
  return {refinement + static_cast<double>(run.rounds.size()) * probing, run.points * of_point,
          kNextRefinement * refinement + probing};
}

AuditGoal HierarchyAudit::goal_of(const AuditedRun& run, std::uint64_t gather_rays) const {
  const Work work = work_of(run, gather_rays);
  // To decide it may take what it would without a filter.
  AuditGoal goal = audit_goal(problem_.options, work.rounds + work.picture, run.target, run.expected);
  goal.seconds = run.seconds;
  if (run.may_go_on) goal.round = work.next_round;
  if (!run.tells_noise) return goal;
  goal.noise = run.noise;
  constexpr double kFiltered = 0.6;
  const auto picture = [work, noise = run.noise](double allowed) {
    return allowed > 0 ? kFiltered * work.picture * noise * noise / (allowed * allowed) : 0;
  };
  // Half of the squared error is its share as long as nothing is known.
  const double share = goal.rays / (work.rounds + work.picture);
  goal.rays = share * (work.rounds + picture(std::max(run.noise, run.target / std::sqrt(2.0))));
  goal.work_left = [picture, allowed = run.allowed_noise, noise = run.noise](double most) {
    return picture(std::max(noise, allowed(most)));
  };
  return goal;
}

std::vector<GatherPoint> HierarchyAudit::points_of_importance(std::span<const GatherPoint> probes,
                                                              const Audit& audit, double target) const {
  constexpr double kMostOfAPlace = 16;
  std::vector<GatherPoint> points(probes.begin(), probes.end());
  if (points.empty()) points = places_;
  for (std::size_t part = 0; part < subject_.parts.size(); ++part) {
    const AuditedMean& mean = audit.parts[part];
    const double over = std::abs(mean.bias) / target;
    if (std::abs(mean.bias) < audit.width * mean.error || over < 0.5) continue;
    const auto times = static_cast<std::size_t>(std::clamp(4 * over * over, 1.0, kMostOfAPlace));
    for (const std::uint32_t place : subject_.parts[part].places)
      points.insert(points.end(), times, places_[place]);
  }
  return points;
}

}  // namespace fluxel
