#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include "core/file.hpp"
#include "method/methods.hpp"
#include "method/photon_light.hpp"
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

std::string ending_sentence(const PhotonResult& result, const PhotonGoal& goal) {
  switch (result.ending) {
    case PhotonEnding::target:
      return "the target error is reached";
    case PhotonEnding::photons:
      return "so many photons were asked for";
    case PhotonEnding::received:
      return fmt::format("{} has received so many photons",
                         goal.limits.error.of.empty() ? "the scene" : goal.limits.error.of);
    case PhotonEnding::time:
      return "the time is up";
    case PhotonEnding::signal:
      return "stopped by a signal";
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
  if (!result.reached && result.ending != PhotonEnding::signal)
    problem.log.warn("the limit of photons or time came before the error asked for");
  if (const Rgb lost = tally.ended(PhotonFate::lost); lost != Rgb(0))
    problem.log.warn(fmt::format("{:.3g} photons were still on their way after {} surfaces and are given up",
                                 mean_of_colours(lost), kMostSteps));
}

}  // namespace

Solution solve_by_photons(const Problem& problem) {
  Solution solution;
  solution.converged = true;
  make_elements(problem, solution);
  const ElementView& mesh = solution.subdivided.mesh;
  const std::vector<Receiver> receivers = counted_receivers(problem);
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
  const TallyKey key{photon_identity(problem.ray_scene, mesh, receivers), points};
  PhotonTally tally =
      request.resume ? restore_tally(problem.world, request.tally, key, shape) : PhotonTally(shape);
  const PhotonAreas areas(mesh, receivers);
  const std::vector<PhotonKind> kinds =
      photon_kinds(areas, receivers, tally.shape(), request.goal.limits.error.of);

  // 2. Photons, until they are enough.
  Stopwatch watch;
  const auto keep = [&](const PhotonTally& of) {
    try {
      write_bytes_atomically(request.tally, tally_file(key, of));
    } catch (const InputError& error) {
      problem.log.warn(error.what());
    }
  };
  problem.progress.begin("photons", static_cast<double>(tally.count(PhotonCount::sent)));
  const PhotonResult result =
      send_photons(workers_of(problem), *scene, kinds, request.goal, tally, request.keep_every, keep);
  problem.progress.end();
  solution.time.solve = watch.lap();

  // 3. The light that they have brought.
  on_root(problem.world, [&] {
    write_bytes_atomically(request.tally, tally_file(key, tally));
    solution.sensors = photon_light(problem.scene, mesh, kinds, receivers, tally, scene->sources().power());
  });
  for (SensorLight& light : solution.sensors) {
    light.measured.reached = result.reached;
    light.measured.stopped = result.ending == PhotonEnding::signal;
    light.seconds = solution.time.solve.wall;
  }
  describe(problem, tally, result, kinds, solution.time.solve.wall);
  solution.stopped = result.ending == PhotonEnding::signal;
  solution.goal_reached = result.reached && tally.count(PhotonCount::met) > 0;
  if (tally.count(PhotonCount::met) == 0)
    problem.log.warn("no photon has met any surface: what emits looks away from all of them");
  solution.photons =
      photon_statistics(scene->sources(), tally, result, ending_sentence(result, request.goal));
  return solution;
}

}  // namespace fluxel
