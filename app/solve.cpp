#include "app/solve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "app/describe.hpp"
#include "app/outputs.hpp"
#include "app/report.hpp"
#include "mpi_master/agreement.hpp"
#include "mpi_master/form_factor_matrix.hpp"
#include "mpi_master/side_view_job.hpp"
#include "mpi_master/subdivision_job.hpp"
#include "mpi_master/transfer.hpp"
#include "visibility/instruction_set.hpp"

namespace fluxel {

namespace {

using Clock = std::chrono::steady_clock;

/// Seconds since the last call, for phase after phase.
class Stopwatch {
 public:
  explicit Stopwatch(Clock::time_point start) : last_(start) {}

  double lap() {
    const auto now = Clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  Clock::time_point last_;
};

Scene load(const Communicator& world, const Options& options, const SceneInput& input) {
  Scene scene;
  on_root(world, [&] {
    require_outputs(options.out);
    SceneSettings settings{options.sides, options.ke, options.cut, std::nullopt};
    if (options.camera) settings.camera_eye = options.camera->eye;
    settings.thermal = options.thermal;
    scene = build_scene(input, settings);
    require_emitter(scene);
  });
  broadcast(world, scene);
  return scene;
}

void solve(const Communicator& world, const Scene& scene, const SubdividedScene& subdivided,
           const TileStore& store, const RayScene& ray_scene, int threads, const Teller& teller,
           Progress& progress, RunReport& report) {
  const Options& options = report.options;
  const ElementMesh& mesh = subdivided.mesh;
  const Unknowns unknowns = make_unknowns(mesh.elements, scene.materials);
  Stopwatch watch(Clock::now());

  progress.begin("form factors");
  const std::vector<SideView> views =
      gather_side_views(world, ray_scene, scene, mesh, unknowns.two_sided, threads);
  report.closed = is_closed(views);
  FormFactorMatrix matrix(world, {ray_scene, scene, mesh, store, unknowns, views}, options.form_factor,
                          threads);
  progress.end();
  report.form_factors = matrix.facts();
  report.seconds.form_factors = watch.lap();
  describe_form_factors(teller, report);

  progress.begin("solve");
  report.row_sums = find_error_weights(matrix.factors(), unknowns, kSinglePrecisionRounding);
  warn_of_amplifying_rows(scene, mesh, teller, report);
  // The bound falls geometrically, so its logarithm tells how far the solve is.
  std::optional<double> first_bound;
  const auto observe = [&](int iteration, double bound) {
    if (!first_bound && std::isfinite(bound) && bound > options.tolerance) first_bound = bound;
    const double all = first_bound ? std::log(*first_bound / options.tolerance) : 0;
    const double done = first_bound ? std::log(*first_bound / std::max(bound, options.tolerance)) : 0;
    progress.update(done, all, fmt::format("iteration {}, error bound {:.2g}", iteration, bound));
  };
  report.radiosity = solve_radiosity(options.solver, matrix.factors(), unknowns, report.row_sums,
                                     {options.tolerance, options.max_iterations}, observe);
  progress.end();
  report.gathered_bytes = matrix.gathered_bytes();
  report.kernel_target = instruction_set_in_use();
  report.energy = energy_balance(unknowns, *report.radiosity, views);
  if (options.thermal)
    report.thermal = thermal_rows(scene, mesh.elements, unknowns, *report.radiosity, report.row_sums);
  report.seconds.solve = watch.lap();
}

std::uint64_t largest_peak(const Communicator& world) {
  auto bytes = static_cast<double>(peak_resident_bytes());
  world.all_max(std::span(&bytes, 1));
  return static_cast<std::uint64_t>(bytes);
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
  on_root(world, [&] {
    write_report(file, report);
    remove_outputs(to_remove);
  });
  teller.say("report: {}", file.string());
}

}  // namespace

int run_solve(const Communicator& world, const SolveRequest& request, Progress& progress,
              Clock::time_point start) {
  Stopwatch total(start), watch(start);
  RunReport report;
  Options options = request.options;

  // 1. The root reads and checks; everybody gets the options and the scene.
  progress.begin("load");
  broadcast(world, options);
  const Teller teller(world, options);
  report.options = options;
  const Scene scene = load(world, options, request.input);
  progress.end();
  for (const std::string& warning : request.warnings) teller.warn(report, warning);
  describe_scene(scene, teller, report);
  report.places = rank_places(world, options.threads);
  const int threads = report.places[static_cast<std::size_t>(world.rank())].threads;
  describe_ranks(teller, report);
  report.seconds.load = watch.lap();

  // 2. Each rank splits its sub-scene until an element covers at most one pixel.
  progress.begin("subdivision");
  const SubdividedScene subdivided = subdivide_scene(world, scene, options, threads);
  const std::vector<Element>& elements = subdivided.mesh.elements;
  report.elements = elements.size();
  report.unknowns = make_unknowns(elements, scene.materials).active;
  report.elements_hash = subdivided.hash;
  report.deepest = subdivided.deepest;
  report.max_edge = subdivided.max_edge;
  progress.end();
  teller.say("subdivision: {} elements, {} unknowns", report.elements, report.unknowns);
  report.seconds.subdivision = watch.lap();

  // 3. What it will cost, before anything heavy starts.
  const RayScene ray_scene(scene, threads);
  const TileTracer tracer(ray_scene, elements, options.trace_every_pair ? Shortcuts::off : Shortcuts::on);
  report.forecast = forecast(world, tracer, report.unknowns, threads);
  teller.say("forecast: {:.4g} pairs, {:.3g} GiB on the largest rank, visibility {:.1f} s",
             static_cast<double>(report.forecast.pairs), static_cast<double>(report.forecast.bytes) * 0x1p-30,
             report.forecast.visibility_seconds);
  require_memory(world, report.forecast.bytes - std::min(report.forecast.bytes, peak_resident_bytes()),
                 "the run");
  report.seconds.forecast = watch.lap();
  if (options.dry_run) {
    report.seconds.total = total.lap();
    for (const std::filesystem::path& file : find_stale(world, options, false))
      teller.warn(report, fmt::format("{} is of an earlier run, not of this dry one", file.string()));
    finish_report(world, teller, {}, report);
    return 0;
  }

  // 4. The visibility matrix: strips are dealt, bits stay with the owners of their rows.
  const Visibility visibility = compute_visibility(world, tracer, threads, progress);
  report.visibility = visibility.counts;
  report.visibility_hash = visibility.hash;
  report.seconds.visibility = watch.lap();
  teller.say("visibility: {:.4g} rays, {} of {} tiles uniform, {:.3g} GiB in all, {:.2f} s",
             static_cast<double>(visibility.counts.rays), visibility.counts.tiles_uniform,
             visibility.counts.tiles_uniform + visibility.counts.tiles_mixed,
             static_cast<double>(visibility.counts.store_bytes) * 0x1p-30, report.seconds.visibility);

  // 5. Radiosity, form factors on the fly, and where the power goes.
  solve(world, scene, subdivided, visibility.store, ray_scene, threads, teller, progress, report);
  describe_solution(scene, teller, report);
  watch.lap();

  // 6. Picture, solution, report.
  progress.begin("image");
  bool written = false;
  on_root(world, [&] { written = write_outputs(scene, subdivided, report); });
  progress.end();
  report.seconds.image = watch.lap();
  report.seconds.total = total.lap();
  if (world.is_root()) describe_outputs(written, teller, report);
  if (!report.radiosity->converged) teller.warn(report, "not converged: " + report.radiosity->cause);
  finish_report(world, teller, find_stale(world, options, written), report);
  return report.radiosity->converged ? 0 : 3;
}

}  // namespace fluxel
