#include "app/solve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "app/describe.hpp"
#include "app/end_of_run.hpp"
#include "app/run_log.hpp"
#include "core/options.hpp"
#include "method/bake.hpp"
#include "method/handle_signals.hpp"
#include "method/idle_options.hpp"
#include "method/kept_links.hpp"
#include "method/load_scene.hpp"
#include "method/methods.hpp"
#include "method/smooth_edges.hpp"
#include "metrics/progress_recorder.hpp"
#include "mpi_master/checkpoint/round_folder.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/transfer.hpp"
#include "output/convergence.hpp"
#include "output/elements/element_file.hpp"
#include "output/elements/reference_elements.hpp"
#include "output/elements/solution_writer.hpp"
#include "output/outputs.hpp"
#include "solver/unknowns.hpp"
#include "visibility/instruction_set.hpp"

namespace fluxel {

namespace {

/// What the program adds to the method's work: the solution to start from, pictures on the way.
ProblemHooks make_hooks(const Options& options, const Scene& scene) {
  ProblemHooks hooks;
  if (!options.warm_start.empty())
    hooks.start = [&](const ElementView& mesh) {
      return read_solution(options.warm_start, scene, mesh, count_unknowns(mesh.elements).two_sided);
    };
  if (options.method == Method::view)
    hooks.finished = [&] {
      ElementFile read = read_element_file(options.solution);
      FinishedSolution finished{shapes_on_scene(options.solution, read, scene), {}};
      for (const char* side : {kRadiosity, kRadiosityBack})
        if (const auto layer = read.layers.find(side); layer != read.layers.end())
          finished.B.insert(finished.B.end(), layer->second.begin(), layer->second.end());
      return finished;
    };
  if (options.preview)
    hooks.early_picture = [&](const SubdividedScene& subdivided, std::span<const Rgb> B,
                              std::size_t picture) {
      const auto file = std::filesystem::path(options.out) / fmt::format("preview-{}s.png", 1 << picture);
      write_early_picture(file, options, scene, subdivided, B);
      return file.string();
    };
  if (shows_rounds(options))
    hooks.round_picture = [&](const EarlyPicture& picture, std::size_t round) {
      const auto file = std::filesystem::path(options.out) / fmt::format("preview-{}.png", round);
      write_early_picture(file, options, picture);
      return file.string();
    };
  return hooks;
}

/// Collective: the root reads and checks; everybody gets the scene, and the polygons of the request go.
Scene load(const Communicator& world, SolveRequest& request, const Options& options, int threads, RunLog& log,
           Progress& progress) {
  progress.begin("load");
  agree(world, [&] { use_instruction_set(options.isa); });
  on_root(world, [&] { require_outputs(options, request.input); });
  Scene scene = load_scene(world, options, threads, request.input, &progress);
  request.input.polygons = {};
  progress.end();
  for (const std::string& warning : request.warnings) log.warn(warning);
  describe_scene(options, scene, log);
  describe_camera(options.camera, request.input, log);
  // Last: a scene that is refused leaves an earlier run's files where they are.
  if (shows_rounds(options) || (options.preview && idle_reason("preview", options).empty()))
    on_root(world, [&] { remove_early_pictures(options.out); });
  return scene;
}

/// On the root: the picture and the solution. A signal comes too late here: what is done is not thrown away.
void write_solution_files(OutputSource& source, Log& log) {
  const RunRecord& record = source.record;
  describe_solution(record, log);
  make_pictures_of(source);
  write_outputs(OutputTime::solution, source);
  describe_outputs(can_be_written(record.solution), record, log);
  source.picture.reset();
}

/// Collective: the processor time of every phase, of all ranks.
void sum_processor_times(const Communicator& world, PhaseTimes& time) {
  std::array<std::uint64_t, kPhases.size()> microseconds{};
  std::ranges::transform(kPhases, microseconds.begin(), [&](const NamedPhase& phase) {
    return static_cast<std::uint64_t>(1e6 * std::max(0.0, (time.*phase.time).processor));
  });
  world.all_sum(microseconds);
  for (std::size_t k = 0; k < kPhases.size(); ++k)
    (time.*kPhases[k].time).processor = 1e-6 * static_cast<double>(microseconds[k]);
}

/// Collective: what all ranks did when, on all: only where somebody wants to see it.
void gather_timelines(const Communicator& world, Solution& solution) {
  if (!solution.matrix) return;
  MatrixStatistics& matrix = *solution.matrix;
  const auto gather = [&](ScheduleRecord& schedule) {
    schedule.timeline = world.all_gather(std::span<const ActivitySpan>(schedule.timeline));
  };
  gather(matrix.visibility_schedule);
  if (matrix.form_factors) gather(matrix.form_factors->corrections_schedule);
}

/// Collective: of the largest rank [bytes].
std::uint64_t largest_peak(const Communicator& world) {
  auto bytes = static_cast<double>(peak_resident_bytes());
  world.all_max(std::span(&bytes, 1));
  return static_cast<std::uint64_t>(bytes);
}

/// On the root: the report and what is written with it; then the folder holds one run's files. A run that
/// ends before its solution leaves an earlier one's where they are.
void finish_files(const OutputSource& source, Log& log) {
  const RunRecord& record = source.record;
  const auto stale = stale_outputs(record);
  const RunEnd end = record.solution.end;
  if (end != RunEnd::solution)
    for (const std::filesystem::path& file : stale)
      log.warn(fmt::format("{} is of an earlier run, not of this {}", file.string(),
                           end == RunEnd::forecast ? "dry one" : "one, which ends with the visibility"));
  write_outputs(OutputTime::end, source);
  if (end == RunEnd::solution) {
    remove_outputs(stale);
    if (!record.options.keep_links && record.options.method != Method::view)
      RoundFolder::remove(links_folder(record.options.out));
  }
  log.say(fmt::format("report: {} (and report.html)",
                      (std::filesystem::path(record.options.out) / "report.json").string()));
}

}  // namespace

int run_solve(const Communicator& world, SolveRequest request, ProgressDisplay& display,
              Stopwatch::Clock::time_point start) {
  Stopwatch total(start), watch(start);
  ProgressRecorder progress(display, request.options.dry_run
                                         ? ProgressRecorder::Keep()
                                         : keep_convergence(world, request.options, "report.html"));
  Options options = request.options;

  // 1. Load: everybody gets the options and the scene.
  broadcast(world, options);
  RunLog log(world, options.quiet);
  const std::vector<RankPlace> places = rank_places(world, options.threads);
  const int threads = places[static_cast<std::size_t>(world.rank())].threads;
  const Scene scene = load(world, request, options, threads, log, progress);
  describe_ranks(options, places, log);
  const RayScene ray_scene(scene, threads);
  describe_places(world, ray_scene, log);
  const PhaseTime load_time = watch.lap();
  handle_signals(world, options, log);

  // 2. Solve: the method answers for the elements, the pixels and the receivers.
  const MethodRow& method = row_of(options.method);
  const Problem problem{.world = world,
                        .scene = scene,
                        .ray_scene = ray_scene,
                        .sensors = sensors_of(options, scene),
                        .options = options,
                        .threads = threads,
                        .progress = progress,
                        .log = log,
                        .hooks = make_hooks(options, scene),
                        .start = start};
  if (bakes(options)) require_bakeable(problem);
  Solution solution = options.dry_run ? method.forecast(problem) : method.solve(problem);
  solution.time.load = load_time;
  watch.lap();

  // 3. Picture and solution.
  RunRecord record{options, scene, solution, places, progress.records(), log.warnings(), {}, 0};
  OutputSource source{record};
  if (solution.end == RunEnd::solution) {
    progress.begin("image");
    record.time = solution.time;
    if (world.is_root() && options.camera && solution.pixel_irradiance.empty() && can_be_written(solution))
      smooth_element_edges(problem, solution);
    on_root(world, [&] { write_solution_files(source, log); });
    progress.end();
    solution.time.image = watch.lap();

    // 4. How good it is, where the method does not say so itself.
    if (method.estimate_error != nullptr) method.estimate_error(problem, solution);
    if (!solution.converged && solution.radiosity) log.warn("not converged: " + solution.radiosity->cause);
  }

  // 5. The report.
  solution.time.total = total.lap();
  record.time = solution.time;
  sum_processor_times(world, record.time);
  record.peak_bytes = largest_peak(world);
  if (options.timeline) gather_timelines(world, solution);
  on_root(world, [&] {
    describe_receivers(record, log);
    finish_files(source, log);
  });
  if (solution.end != RunEnd::solution) return 0;
  if (solution.stopped) return kStopped;
  return solution.converged && solution.goal_reached ? 0 : 3;
}

}  // namespace fluxel
