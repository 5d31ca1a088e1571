#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include "core/file.hpp"
#include "method/methods.hpp"
#include "method/photon_light.hpp"
#include "method/renewed_photons.hpp"
#include "method/subdivide.hpp"
#include "mpi_master/checkpoint/kept_tally.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "solver/unknowns.hpp"
#include "subdivision/add_element.hpp"

namespace fluxel {

namespace {

/// Collective: those of a file, or as the options make them; none where receivers alone are measured.
void make_elements(const Problem& problem, Solution& solution) {
  if (!problem.photons.measures_elements) return;
  if (problem.sensors.elements.empty()) {
    subdivide(problem, {}, solution);
    return;
  }
  ElementMesh mesh;
  on_root(problem.world, [&] {
    for (const ElementShape& shape : problem.sensors.elements)
      add_element(problem.scene, shape.patch, shape.outline, mesh);
  });
  share_elements(problem.world, mesh, solution.subdivided);
}

std::vector<Receiver> counted_receivers(const Problem& problem) {
  std::vector<Receiver> counted;
  for (const Receiver& receiver : problem.sensors.receivers) {
    if (is_counted(receiver))
      counted.push_back(receiver);
    else
      problem.log.warn(fmt::format(
          "receiver {}: photons measure irradiance over grids alone, and leave it out: 'fluxel reference' "
          "measures it",
          receiver.name));
  }
  return counted;
}

void warn_of_observers(const Problem& problem) {
  if (!problem.scene.observers.empty())
    problem.log.warn("photons rate no glare: [[observers]] are left out; 'fluxel reference' rates them");
}

std::string ending_sentence(const PhotonResult& result, const PhotonGoal& goal) {
  switch (result.ending) {
    case PhotonEnding::target:
      return "the target error is reached";
    case PhotonEnding::photons:
      return "so many photons were asked for";
    case PhotonEnding::received:
      return fmt::format("{} has received so many photons",
                         goal.limits.error.of.empty() ? "the scene" : goal.limits.error.of);
    case PhotonEnding::vain:
      return "no photon has come to where the error was asked for";
    case PhotonEnding::time:
      return "the time is up";
    case PhotonEnding::signal:
      return "stopped by a signal";
    case PhotonEnding::renewed:
      return "all photons have gone again";
  }
  return {};
}

/// What is said at the end, and warned of.
void describe(const Problem& problem, const PhotonTally& tally, const PhotonResult& result,
              std::span<const PhotonKind> kinds, double seconds) {
  const auto sent = static_cast<double>(tally.count(PhotonCount::sent));
  problem.log.say(fmt::format("photons: {:.4g} sent, {:.3g} rays and {:.3g} coordinates each, {:.2f} s: {}",
                              sent, static_cast<double>(tally.count(PhotonCount::segments)) / sent,
                              static_cast<double>(tally.count(PhotonCount::coordinates)) / sent, seconds,
                              ending_sentence(result, problem.photons.goal)));
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const IrradianceErrors& errors = result.turns.back().errors[k];
    if (tally.received(kinds[k].received) == 0)
      problem.log.warn(fmt::format("{}: no photon has come there", kinds[k].name));
    else
      problem.log.say(fmt::format("{}: error {:.3g} % of the mean irradiance", kinds[k].name,
                                  100 * relative_error(errors)));
  }
  if (!result.reached && result.ending != PhotonEnding::signal && problem.photons.before == nullptr)
    problem.log.warn(
        fmt::format("the error asked for is not reached: {}", ending_sentence(result, problem.photons.goal)));
  if (const Rgb lost = tally.ended(PhotonFate::lost); lost != Rgb(0))
    problem.log.warn(fmt::format("{:.3g} photons were still on their way after {} surfaces and are given up",
                                 mean_of_colours(lost), kMostSteps));
}

/// What a problem's photons count at.
struct Counters {
  const PhotonScene& scene;
  const ElementView& mesh;
  std::span<const Receiver> receivers;
  std::span<const PhotonKind> kinds;
  TallyKey key;
};

/// What photons have brought, and what ended them.
struct PhotonWork {
  PhotonTally tally;
  PhotonResult result;
  std::optional<RenewalResult> renewal;
};

/// Why it could not be written; empty: it stands there.
std::string keep_tally(const std::filesystem::path& file, const TallyKey& key, const PhotonTally& tally) {
  try {
    write_bytes_atomically(file, tally_file(key, tally));
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

/// Collective.
PhotonWork send(const Problem& problem, const Counters& at, const TallyShape& shape) {
  const PhotonRequest& request = problem.photons;
  PhotonWork work{
      request.resume ? restore_tally(problem.world, request.tally, at.key, shape) : PhotonTally(shape),
      {},
      {}};
  const auto keep = [&](const PhotonTally& of) {
    if (const std::string failure = keep_tally(request.tally, at.key, of); !failure.empty())
      problem.log.warn(failure);
  };
  problem.progress.begin("photons", static_cast<double>(work.tally.count(PhotonCount::sent)));
  work.result = send_photons(workers_of(problem), at.scene, at.kinds, request.goal, work.tally,
                             request.keep_every, keep);
  problem.progress.end();
  return work;
}

/// Collective.
PhotonWork renew(const Problem& problem, const Counters& at) {
  const double power = at.scene.sources().power();
  const auto show = [&](const PhotonTally& of) {
    if (!problem.hooks.counted) return;
    for (SensorLight& light : photon_light(problem.scene, at.mesh, at.kinds, at.receivers, of, power)) {
      light.measured.reached = false;
      light.measured.partly_before = true;
      problem.hooks.counted(at.mesh, light);
    }
  };
  problem.progress.begin("renewal");
  RenewedPhotons renewed = renew_kept_photons(problem, at.scene, at.mesh, at.receivers, at.key, show);
  problem.progress.end();
  const RenewalResult& renewal = renewed.result;
  PhotonResult result;
  result.restored = renewal.photons;
  result.reached = renewal.complete();
  result.ending = renewal.ending;
  PhotonTurn& turn = result.turns.emplace_back();
  turn.photons = renewal.photons;
  turn.seconds = renewal.turns.back().seconds;
  for (const PhotonKind& kind : at.kinds)
    turn.errors.push_back(irradiance_errors(renewed.tally, kind.slots, power));
  return {std::move(renewed.tally), std::move(result), renewal};
}

void describe_renewal(const RenewalResult& renewal, Log& log) {
  const RenewalTurn& last = renewal.turns.back();
  log.say(fmt::format("renewal: {} of {} photons in {} of {} groups have gone again, {} of them otherwise",
                      last.renewed, renewal.photons, last.groups, renewal.groups, last.changed));
  if (!renewal.complete())
    log.warn(
        fmt::format("not all photons have gone again: some {:.3g} of {} still bring the light of the scene "
                    "before, and no "
                    "tally of this scene is kept",
                    last.left, renewal.photons));
}

}  // namespace

Solution solve_by_photons(const Problem& problem) {
  Solution solution;
  solution.converged = true;
  make_elements(problem, solution);
  const ElementView& mesh = solution.subdivided.mesh;
  const std::vector<Receiver> receivers = counted_receivers(problem);
  warn_of_observers(problem);
  agree(problem.world, [&] {
    if (mesh.elements.empty() && receivers.empty())
      throw InputError("there is nothing to measure: photons count on elements and on grids of irradiance");
  });

  // 1. What photons meet, and where they count.
  const PhotonRequest& request = problem.photons;
  std::optional<PhotonScene> scene;
  agree(problem.world, [&] { scene.emplace(problem.ray_scene, mesh, receivers); });
  const PhotonPoints& points = request.goal.points;
  const TallyShape shape = scene->shape(parts_of(points.sequence), points.sequence == Sequence::random);
  const PhotonAreas areas(mesh, receivers);
  const std::vector<PhotonKind> kinds = photon_kinds(areas, receivers, shape, request.goal.limits.error);
  const Counters counters{
      *scene, mesh, receivers, kinds, {photon_identity(problem.ray_scene, mesh, receivers), points}};

  // 2. Photons, until they are enough.
  Stopwatch watch;
  const PhotonWork work =
      request.before != nullptr ? renew(problem, counters) : send(problem, counters, shape);
  const PhotonTally& tally = work.tally;
  const PhotonResult& result = work.result;
  const bool is_whole = !work.renewal || work.renewal->complete();
  solution.time.solve = watch.lap();

  // 3. The light that they have brought.
  on_root(problem.world, [&] {
    solution.sensors = photon_light(problem.scene, mesh, kinds, receivers, tally, scene->sources().power());
  });
  for (SensorLight& light : solution.sensors) {
    light.measured.reached = result.reached;
    light.measured.partly_before = !is_whole;
    light.measured.stopped = result.ending == PhotonEnding::signal;
    light.seconds = solution.time.solve.wall;
  }
  std::string failure;
  on_root(problem.world, [&] {
    if (is_whole) failure = keep_tally(request.tally, counters.key, tally);
  });
  describe(problem, tally, result, kinds, solution.time.solve.wall);
  if (work.renewal) describe_renewal(*work.renewal, problem.log);
  solution.stopped = result.ending == PhotonEnding::signal;
  solution.goal_reached = result.reached && tally.count(PhotonCount::met) > 0;
  if (tally.count(PhotonCount::met) == 0)
    problem.log.warn("no photon has met any surface: what emits looks away from all of them");
  solution.photons =
      photon_statistics(scene->sources(), tally, result, ending_sentence(result, request.goal));
  solution.photons->renewal = work.renewal;
  solution.photons->unkept = failure;
  return solution;
}

}  // namespace fluxel
