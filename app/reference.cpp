#include "app/reference.hpp"

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
#include "output/reference_files.hpp"
#include "visibility/instruction_set.hpp"

namespace fluxel {

namespace {

/// What can be a target of error.
std::vector<std::string> names_of_reference(const ReferenceOptions& options, const Scene& scene) {
  std::vector<std::string> names;
  if (options.measures_elements()) names.emplace_back("elements");
  if (options.measures_picture()) names.emplace_back("picture");
  if (options.measures(Measured::receivers))
    for (const Receiver& receiver : scene.receivers) names.push_back(receiver.name);
  return names;
}

}  // namespace

int run_reference(const Communicator& world, const ReferenceRequest& request, ProgressDisplay& display,
                  Stopwatch::Clock::time_point start) {
  // 1. Load: the root reads and checks; everybody gets the options, the scene and the elements.
  Stopwatch watch(start);
  ReferenceOptions options = request.options;
  broadcast(world, options);
  agree(world, [&] { use_instruction_set(options.run.isa); });
  RunLog log(world, options.run.quiet);
  for (const std::string& warning : request.warnings) log.warn(warning);
  const std::filesystem::path folder = options.run.out;
  on_root(world, [&] {
    std::vector<std::filesystem::path> inputs = request.input.files;
    if (options.measures_elements()) inputs.emplace_back(options.elements);
    require_inputs_kept(inputs,
                        measured_outputs(folder, measured_run(options).stem, request.input.receivers));
    require_writable_folder(folder);
  });
  const int threads = rank_places(world, options.run.threads)[static_cast<std::size_t>(world.rank())].threads;
  const Scene scene = load_scene(world, options.run, threads, request.input);
  describe_scene(options.run, scene, log);
  if (options.measures_picture()) describe_camera(options.run.camera, request.input, log);
  agree(world, [&] { require_measured(options.limits.error, names_of_reference(options, scene)); });
  const GivenElements elements =
      read_given_elements(world, options.measures_elements() ? options.elements : "", scene);
  const RayScene ray_scene(scene, threads);
  describe_places(world, ray_scene, log);
  ProgressRecorder progress(display, keep_convergence(world, options.run, "reference.html"));
  const double load_seconds = watch.lap().wall;

  // 2. Solve: paths of light answer for what is asked, one kind of sensor after another.
  Problem problem{.world = world,
                  .scene = scene,
                  .ray_scene = ray_scene,
                  .sensors = {.elements = elements.shapes, .supersample = options.supersample},
                  .options = options.run,
                  .threads = threads,
                  .progress = progress,
                  .log = log,
                  .paths = {options.limits, options.sampling, options.seed}};
  if (options.measures_picture()) problem.sensors.camera = &*options.run.camera;
  if (options.measures(Measured::receivers)) {
    problem.sensors.receivers = scene.receivers;
    problem.sensors.observers = scene.observers;
  }
  problem.hooks.measured = [&](const SensorLight& light) {
    const auto file = write_measured(measured_run(options), elements.of_file, light);
    log.say(fmt::format("{}: {}", light.name(), file.string()));
  };
  const Solution solution = row_of(Method::paths).solve(problem);

  // 3. The report: how exact it is.
  on_root(world, [&] {
    write_reference_report(options, scene, {world.size(), threads, load_seconds}, solution, elements.of_file,
                           progress.records());
  });
  if (solution.stopped) return kStopped;
  return solution.goal_reached ? 0 : 3;
}

}  // namespace fluxel
