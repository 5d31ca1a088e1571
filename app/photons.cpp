#include "app/photons.hpp"

#include <fmt/format.h>

#include "app/describe.hpp"
#include "app/end_of_run.hpp"
#include "app/given_elements.hpp"
#include "app/option_checks.hpp"
#include "app/run_log.hpp"
#include "core/file.hpp"
#include "core/options.hpp"
#include "method/load_scene.hpp"
#include "method/methods.hpp"
#include "metrics/progress_recorder.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/machine.hpp"
#include "mpi_master/communication/transfer.hpp"
#include "output/convergence.hpp"
#include "output/photon_files.hpp"
#include "visibility/instruction_set.hpp"

namespace fluxel {

namespace {

/// What can be a target of error.
std::vector<std::string> names_of_photons(const PhotonOptions& options, const Scene& scene) {
  std::vector<std::string> names;
  if (options.measures(Measured::elements)) names.emplace_back("elements");
  if (options.measures(Measured::receivers))
    for (const Receiver& receiver : scene.receivers)
      if (is_counted(receiver)) names.push_back(receiver.name);
  return names;
}

PhotonRequest request_of(const PhotonOptions& options) {
  return {.goal = {{options.sequence, options.seed}, options.limits},
          .measures_elements = options.measures(Measured::elements),
          .measures_receivers = options.measures(Measured::receivers),
          .tally = tally_path(options),
          .resume = options.run.resume,
          .keep_every = options.run.checkpoint_every};
}

}  // namespace

int run_photons(const Communicator& world, const PhotonsRequest& request, ProgressDisplay& display,
                Stopwatch::Clock::time_point start) {
  // 1. Load: the root reads and checks; everybody gets the options, the scene and the elements.
  Stopwatch watch(start);
  PhotonOptions options = request.options;
  broadcast(world, options);
  agree(world, [&] { use_instruction_set(options.run.isa); });
  RunLog log(world, options.run.quiet);
  for (const std::string& warning : request.warnings) log.warn(warning);
  const std::filesystem::path folder = options.run.out, tally = tally_path(options);
  on_root(world, [&] {
    std::vector<std::filesystem::path> inputs = request.input.files;
    if (request.before)
      inputs.insert(inputs.end(), request.before->files.begin(), request.before->files.end());
    if (!options.elements.empty()) inputs.emplace_back(options.elements);
    std::vector<std::filesystem::path> outputs =
        measured_outputs(folder, measured_run(options).stem, request.input.receivers);
    outputs.push_back(tally);
    require_inputs_kept(inputs, outputs);
    require_writable_folder(folder);
    require_writable_folder(tally.parent_path());
  });
  const int threads = rank_places(world, options.run.threads)[static_cast<std::size_t>(world.rank())].threads;
  const Scene scene = load_scene(world, options.run, threads, request.input);
  agree(world, [&] { require_measured(options.limits.error, names_of_photons(options, scene)); });
  std::optional<Scene> before;
  std::optional<RayScene> before_rays;
  if (!options.changed_from.empty()) {
    before = load_scene(world, options.run, threads, request.before.value_or(SceneInput{}));
    before_rays.emplace(*before, threads);
  }
  const GivenElements elements = read_given_elements(world, options.elements, scene);
  const RayScene ray_scene(scene, threads);
  describe_scene(options.run, scene, log);
  describe_places(world, ray_scene, log);
  ProgressRecorder progress(display, keep_convergence(world, options.run, "photons.html"));
  const double load_seconds = watch.lap().wall;

  // 2. Photons.
  Problem problem{.world = world,
                  .scene = scene,
                  .ray_scene = ray_scene,
                  .sensors = {.elements = elements.shapes},
                  .options = options.run,
                  .threads = threads,
                  .progress = progress,
                  .log = log,
                  .photons = request_of(options)};
  if (options.measures(Measured::receivers)) problem.sensors.receivers = scene.receivers;
  problem.photons.before = before_rays ? &*before_rays : nullptr;
  problem.photons.groups = options.groups;
  const auto write = [&](const ElementView& mesh, const SensorLight& light) {
    const bool makes_elements = options.elements.empty() && light.kind == Measured::elements;
    return write_measured(measured_run(options),
                          makes_elements ? file_elements(scene, mesh) : elements.of_file, light);
  };
  problem.hooks.counted = [&](const ElementView& mesh, const SensorLight& light) {
    static_cast<void>(write(mesh, light));
  };
  const Solution solution = row_of(Method::photons).solve(problem);

  // 3. What they have brought, and how exact it is.
  on_root(world, [&] {
    for (const SensorLight& light : solution.sensors)
      log.say(fmt::format("{}: {}", light.name(), write(solution.subdivided.mesh, light).string()));
    const bool makes_elements = options.elements.empty() && options.measures(Measured::elements);
    write_photon_report(options, scene, {world.size(), threads, load_seconds}, solution,
                        makes_elements ? file_elements(scene, solution.subdivided.mesh) : elements.of_file,
                        progress.records());
    // After all else, so that nothing is lost for it.
    if (!solution.photons->unkept.empty()) throw InputError(solution.photons->unkept);
  });
  if (solution.stopped) return kStopped;
  return solution.goal_reached ? 0 : 3;
}

}  // namespace fluxel
