#include "app/solve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "app/convergence.hpp"
#include "app/describe.hpp"
#include "app/estimate_step.hpp"
#include "app/heed_signals.hpp"
#include "app/hierarchical_step.hpp"
#include "app/load_scene.hpp"
#include "app/outputs.hpp"
#include "app/report.hpp"
#include "app/solve_step.hpp"
#include "app/stopwatch.hpp"
#include "app/timeline.hpp"
#include "app/visibility_step.hpp"
#include "metrics/progress_recorder.hpp"
#include "mpi_master/agreement.hpp"
#include "mpi_master/subdivision_job.hpp"
#include "mpi_master/transfer.hpp"
#include "scene/solution_writer.hpp"
#include "visibility/instruction_set.hpp"

namespace fluxel {

namespace {

/// The radiosity that the run starts from, on leaders; empty without --warm-start.
std::vector<Rgb> load_start(const Communicator& world, const Options& options, const Scene& scene,
                            const ElementView& mesh) {
  std::vector<Rgb> start;
  if (options.warm_start.empty()) return start;
  on_root(world, [&] {
    const bool two_sided = count_unknowns(mesh.elements).two_sided;
    start = read_solution(options.warm_start, scene, mesh, two_sided);
  });
  if (!world.is_leader()) return start;
  // One range, the root's.
  return world.leaders().all_gather(std::span<const Rgb>(start));
}

std::uint64_t largest_peak(const Communicator& world) {
  auto bytes = static_cast<double>(peak_resident_bytes());
  world.all_max(std::span(&bytes, 1));
  return static_cast<std::uint64_t>(bytes);
}

/// The processor time of every phase, of all ranks.
void sum_processor_times(const Communicator& world, PhaseTimes& time) {
  const std::array phases{&time.load,         &time.subdivision, &time.forecast, &time.visibility,
                          &time.form_factors, &time.preview,     &time.solve,    &time.gather,
                          &time.image,        &time.estimate,    &time.total};
  std::array<std::uint64_t, phases.size()> microseconds{};
  std::ranges::transform(phases, microseconds.begin(), [](const PhaseTime* phase) {
    return static_cast<std::uint64_t>(1e6 * std::max(0.0, phase->processor));
  });
  world.all_sum(microseconds);
  for (std::size_t k = 0; k < phases.size(); ++k)
    phases[k]->processor = 1e-6 * static_cast<double>(microseconds[k]);
}

/// What all ranks did when, on all: only where somebody wants to see it.
void gather_timelines(const Communicator& world, RunReport& report) {
  for (DealtTiles* dealt : {&report.visibility_dealt, &report.form_factors.corrections_dealt})
    dealt->timeline = world.all_gather(std::span<const ActivitySpan>(dealt->timeline));
}

/// What an earlier run left in the folder and this one has not replaced. A dry run leaves it where it is.
std::vector<std::filesystem::path> find_stale(const Communicator& world, const Options& options,
                                              bool written) {
  if (!world.is_root()) return {};
  return stale_outputs(options, written);
}

/// The report is written last, since it names the time of all the rest; then the folder holds one run's
/// files.
void finish_report(const Communicator& world, const Teller& teller,
                   const std::vector<std::filesystem::path>& to_remove, RunReport& report) {
  const std::filesystem::path file = std::filesystem::path(report.options.out) / "report.json";
  report.peak_bytes = largest_peak(world);
  if (report.options.timeline) gather_timelines(world, report);
  sum_processor_times(world, report.time);
  on_root(world, [&] {
    if (!report.options.dry_run) write_convergence(file.parent_path() / "convergence.csv", report.phases);
    if (report.options.timeline && report.visibility)
      write_timeline(file.parent_path() / "timeline.csv", report);
    write_report(file, report);
    remove_outputs(to_remove);
  });
  teller.say("report: {}", file.string());
}

/// The end of a run that makes nothing but its report.
void finish_early(const Communicator& world, const Teller& teller, const char* kind, Stopwatch& total,
                  RunReport& report) {
  report.time.total = total.lap();
  for (const std::filesystem::path& file : find_stale(world, report.options, false))
    teller.warn(report, fmt::format("{} is of an earlier run, not of this {}", file.string(), kind));
  finish_report(world, teller, {}, report);
}

/// What the steps of a run work on.
struct Run {
  const Communicator& world;
  const Options& options;
  const Scene& scene;
  int threads;
  const Teller& teller;
  ProgressRecorder& progress;
  Stopwatch &total, &watch;
  RunReport& report;
};

/// Steps 3 to 5 over all pairs of elements, and how good that is. Nothing where the run ends early.
std::optional<bool> solve_by_matrix(const Run& run, const SubdividedScene& subdivided,
                                    const RayScene& ray_scene) {
  const auto& [world, options, scene, threads, teller, progress, total, watch, report] = run;
  const std::span<const Element> elements = subdivided.mesh.elements;
  const std::vector<Rgb> first = load_start(world, options, scene, subdivided.mesh);

  // 3. What it will cost, before anything heavy starts.
  std::optional<TileTracer> tracer(std::in_place, ray_scene, elements,
                                   options.trace_every_pair ? Shortcuts::off : Shortcuts::on);
  report.forecast = forecast(world, *tracer, report.unknowns, threads,
                             options.dry_run ? SampleUse::totals : SampleUse::shares,
                             PairsToCorrect{ray_scene, scene, subdivided.mesh, options.form_factor});
  teller.say("forecast: {:.4g} pairs, {:.3g} GiB on the largest rank, visibility {:.1f} s",
             static_cast<double>(report.forecast.pairs), static_cast<double>(report.forecast.bytes) * 0x1p-30,
             report.forecast.visibility_seconds);
  require_memory(world, report.forecast.to_come, "the run");
  report.time.forecast = watch.lap();
  if (options.dry_run) {
    finish_early(world, teller, "dry one", total, report);
    return std::nullopt;
  }
  heed_signals(world, options);

  // 4. The visibility matrix: strips are dealt, bits stay with the owners of their rows.
  std::optional<Visibility> visibility(
      visibility_step(world, ray_scene, elements, *tracer, threads, teller, progress, report));
  tracer.reset();  // the solve needs the memory
  report.time.visibility = watch.lap();
  describe_visibility(teller, report);
  report.phases = progress.records();
  if (options.visibility_only) {
    finish_early(world, teller, "one, which ends with the visibility", total, report);
    return std::nullopt;
  }
  heed_signals(world, options);

  // 5. Radiosity, form factors on the fly, and where the power goes.
  return solve_step(world, {scene, subdivided, ray_scene, *visibility, first, threads}, teller, progress,
                    report);
}

}  // namespace

int run_solve(const Communicator& world, const SolveRequest& request, ProgressDisplay& display,
              Stopwatch::Clock::time_point start) {
  Stopwatch total(start), watch(start);
  RunReport report;
  ProgressRecorder progress(display, keep_convergence(world, request.options));
  Options options = request.options;

  // 1. The root reads and checks; everybody gets the options and the scene.
  progress.begin("load");
  broadcast(world, options);
  agree(world, [&] { use_instruction_set(options.isa); });
  const Teller teller(world, options);
  report.options = options;
  on_root(world, [&] { require_outputs(options.out); });
  const Scene scene = load_scene(world, options, request.input);
  progress.end();
  for (const std::string& warning : request.warnings) teller.warn(report, warning);
  describe_scene(scene, teller, report);
  if (!scene.receivers.empty())
    teller.say("note: receivers are measured by `fluxel reference`, not by a solve");
  report.places = rank_places(world, options.threads);
  const int threads = report.places[static_cast<std::size_t>(world.rank())].threads;
  describe_ranks(teller, report);
  report.time.load = watch.lap();
  heed_signals(world, options);

  // 2. Each rank splits its sub-scene until an element covers at most one pixel.
  progress.begin("subdivision");
  const bool by_matrix = options.method == Method::matrix;
  BytesOfElements bytes_to_follow;
  if (by_matrix) bytes_to_follow = [&world](std::size_t elements) { return least_bytes(world, elements); };
  SubdividedScene subdivided = subdivide_scene(world, scene, options, threads, bytes_to_follow);
  // The root makes the pictures; by blocks all ranks have a part in each pixel.
  if (!world.is_root() && by_matrix) subdivided.raster = {};
  const std::span<const Element> elements = subdivided.mesh.elements;
  report.elements = elements.size();
  report.unknowns = count_unknowns(elements).active;
  report.elements_hash = subdivided.hash;
  report.deepest = subdivided.deepest;
  report.max_edge = subdivided.max_edge;
  progress.end();
  teller.say("subdivision: {} elements, {} unknowns", report.elements, report.unknowns);
  report.time.subdivision = watch.lap();
  heed_signals(world, options);

  // 3. to 5. Radiosity: by blocks, or by all pairs.
  const Run run{world, options, scene, threads, teller, progress, total, watch, report};
  std::vector<Rgb> picture_irradiance;  // by blocks: of each pixel on its own
  std::optional<RayScene> ray_scene;
  std::optional<bool> converged;
  if (options.method == Method::hierarchical) {
    converged =
        hierarchical_step(world, scene, threads, subdivided, picture_irradiance, teller, progress, report);
  } else {
    ray_scene.emplace(scene, threads);
    converged = solve_by_matrix(run, subdivided, *ray_scene);
  }
  if (!converged) return 0;
  if (world.is_root()) describe_solution(scene, teller, report);
  watch.lap();

  // 6. Picture and solution. A signal comes too late here: what is done is not thrown away.
  progress.begin("image");
  bool written = false;
  on_root(world, [&] { written = write_outputs(scene, subdivided, picture_irradiance, report); });
  progress.end();
  report.time.image = watch.lap();
  if (world.is_root()) describe_outputs(written, teller, report);

  // 7. How good it is, and the report.
  if (options.error_estimate && options.method == Method::matrix)
    estimate_step(world, {scene, subdivided, *ray_scene, *converged, threads}, teller, progress, report);
  report.phases = progress.records();
  report.time.total = total.lap();
  if (world.is_root() && !*converged) teller.warn(report, "not converged: " + report.radiosity->cause);
  finish_report(world, teller, find_stale(world, options, written), report);
  return *converged ? 0 : 3;
}

}  // namespace fluxel
