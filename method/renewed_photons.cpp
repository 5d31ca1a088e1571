#include "method/renewed_photons.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "mpi_master/checkpoint/kept_tally.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/steps/subdivision_job.hpp"
#include "photons/photon_groups.hpp"

namespace fluxel {

namespace {

[[noreturn]] void refuse(const std::string& what, const std::string& hint) {
  throw InputError(fmt::format("--changed-from: {} ({})", what, hint));
}

/// A patch with what light meets there, to compare.
auto content_of(const Scene& scene, const Patch& patch) {
  std::vector<double> numbers;
  for (std::size_t k = 0; k < patch.outline.corners; ++k)
    for (int axis = 0; axis < 3; ++axis) numbers.push_back(patch.outline.corner[k][axis]);
  return std::tuple(patch.sides, numbers, light_of(scene.material(patch)));
}

/// How many patches of a scene another one has, too.
std::size_t common_patches(const Scene& a, const Scene& b) {
  std::multiset<decltype(content_of(a, a.patches.front()))> of_a;
  for (const Patch& patch : a.patches) of_a.insert(content_of(a, patch));
  std::size_t common = 0;
  for (const Patch& patch : b.patches)
    if (const auto found = of_a.find(content_of(b, patch)); found != of_a.end()) {
      of_a.erase(found);
      ++common;
    }
  return common;
}

bool is_same(const Receiver& a, const Receiver& b) {
  return std::tie(a.origin, a.u, a.v, a.columns, a.rows, a.unmeasured) ==
         std::tie(b.origin, b.u, b.v, b.columns, b.rows, b.unmeasured);
}

/// Throws InputError where photons of one scene cannot be renewed for the other.
void require_renewable(const RayScene& before, const RayScene& after) {
  const Scene &old = before.scene(), &now = after.scene();
  const char* const anew = "leave it and --resume out: photons have to start anew";
  if (old.units != now.units) refuse("that scene has other units", anew);
  if (old.origin != now.origin || old.extent != now.extent ||
      before.surface_epsilon() != after.surface_epsilon())
    refuse("the box around the scene has changed, and with it where all its points are rounded to",
           "what moves has to stay within the box of all that stays");
  if (common_patches(old, now) == 0) refuse("that scene has no surface in common with this one", anew);
  if (!PhotonSources(before).emits_as(PhotonSources(after)))
    refuse("what emits light has changed, so that every photon starts elsewhere", anew);
}

}  // namespace

RenewedPhotons renew_kept_photons(const Problem& problem, const PhotonScene& after, const ElementView& mesh,
                                  std::span<const Receiver> receivers, const TallyKey& key,
                                  const std::function<void(const PhotonTally&)>& show) {
  const PhotonRequest& request = problem.photons;
  const RayScene& rays = *request.before;
  agree(problem.world, [&] { require_renewable(rays, problem.ray_scene); });
  SubdividedScene subdivided;
  if (request.measures_elements)
    subdivided = subdivide_scene(problem.world, rays.scene(), problem.options, problem.threads);
  std::vector<Receiver> old_receivers;
  if (request.measures_receivers)
    std::ranges::copy_if(rays.scene().receivers, std::back_inserter(old_receivers), is_counted);
  agree(problem.world, [&] {
    if (!std::ranges::equal(old_receivers, receivers, is_same))
      refuse("that scene has other receivers", "give both the same, or --only elements");
  });

  const PhotonScene before(rays, subdivided.mesh, old_receivers);
  const TallyShape shape = before.shape(parts_of(key.points.sequence), false);
  const TallyKey old_key{photon_identity(rays, subdivided.mesh, old_receivers), key.points};
  const PhotonTally old = restore_tally(
      problem.world, request.tally, old_key, shape,
      "the tally of --changed-from is needed, with the same --max-edge, --no-cut and --only; one "
      "that has been renewed goes on without --changed-from");
  const PhotonRenewal renewal(
      before, after,
      PhotonRenewal::same_slots(subdivided.mesh, shape, mesh, after.shape(shape.parts, false)));

  const std::uint64_t photons = old.count(PhotonCount::sent);
  agree(problem.world, [&] {
    if (request.groups && *request.groups > photons)
      throw InputError(fmt::format("--groups {}: there are {} photons, and a group has one at least",
                                   *request.groups, photons));
  });
  const std::vector<std::uint64_t> partings =
      coherent_groups(request.groups.value_or(std::max<std::uint64_t>(photons / kLeastOfGroup, 1)));
  const std::size_t common = common_patches(rays.scene(), problem.scene);
  problem.log.say(fmt::format("changed: {} of {} surfaces, {} photons in {} groups",
                              problem.scene.patches.size() - common, problem.scene.patches.size(), photons,
                              partings.back()));
  RenewedPhotons renewed{renewal.taken_over(old), {}};
  const RenewalGoal goal{photons, partings, request.goal.limits.seconds, request.goal.limits.photons};
  renewed.result = renew_photons(workers_of(problem), renewal, goal, renewed.tally, show);
  return renewed;
}

}  // namespace fluxel
