#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <optional>

#include "core/signals.hpp"
#include "hierarchy/link_hierarchy.hpp"
#include "hierarchy/ray_hierarchy.hpp"
#include "method/element_light.hpp"
#include "method/error_control.hpp"
#include "method/handle_signals.hpp"
#include "method/methods.hpp"
#include "method/picture_light.hpp"
#include "method/probes.hpp"
#include "method/receiver_light.hpp"
#include "method/round_preview.hpp"
#include "method/say_checkpoint.hpp"
#include "method/subdivide.hpp"
#include "mpi_master/communication/communicator_ranks.hpp"
#include "mpi_master/communication/machine.hpp"
#include "mpi_master/steps/side_view_job.hpp"
#include "solver/closure.hpp"
#include "visibility/instruction_set.hpp"

namespace fluxel {

namespace {

/// Tree and links may take this part of the memory that there is.
constexpr double kMemoryShare = 0.8;

/// Collective.
void trace_samples(const Problem& problem, const ElementMesh& mesh, std::span<SideSample> samples) {
  std::vector<std::uint32_t> sides;
  sides.reserve(samples.size());
  for (const SideSample& sample : samples) sides.push_back(sample.unknown);
  const std::vector<SideView> views =
      views_of_sides(problem.world, problem.ray_scene, problem.scene, mesh, sides, problem.threads);
  for (std::size_t k = 0; k < samples.size(); ++k) samples[k].view = views[k];
}

/// Collective: where the power of the leaves goes.
void balance_energy(const Problem& problem, const Hierarchy& hierarchy, Solution& solution) {
  const ElementMesh mesh = hierarchy.tree().elements();
  const Unknowns& unknowns = hierarchy.leaves().unknowns();
  std::vector<SideSample> samples = choose_sides(unknowns, hierarchy.radiosity().B);
  trace_samples(problem, mesh, samples);
  solution.closed = is_closed(samples);
  solution.energy = energy_balance(unknowns, hierarchy.radiosity(), samples);
  solution.row_sums = hierarchy.row_sums();
  const std::span<const double> sums = hierarchy.own_row_sums();
  solution.form_factor_sums = {sums.empty() ? 0 : *std::ranges::max_element(sums),
                               closure_defect_rms(unknowns, sums, samples), hierarchy.closure()};
  if (problem.options.thermal)
    solution.thermal =
        thermal_rows(problem.scene, mesh.elements, unknowns, hierarchy.radiosity(), hierarchy.row_sums());
}

/// Collective.
void sum_counts(const Communicator& world, const Hierarchy& hierarchy, HierarchyStatistics& statistics) {
  const RefinementCounts& counts = hierarchy.counts();
  std::array<std::uint64_t, 5> sums{counts.pairs, counts.shafts, counts.contours, counts.rays,
                                    hierarchy.gather_rays()};
  world.all_sum(sums);
  statistics.pairs = sums[0], statistics.shafts = sums[1], statistics.contours = sums[2];
  statistics.rays = sums[3], statistics.gather_rays = sums[4];
  auto bytes = static_cast<double>(hierarchy.bytes());
  world.all_max(std::span(&bytes, 1));
  statistics.bytes = static_cast<std::uint64_t>(bytes);
}

OracleParts oracle_parts(const Options& options) {
  const Oracle oracle = options.oracle;
  return {oracle == Oracle::all || oracle == Oracle::power,
          oracle == Oracle::all || oracle == Oracle::importance, options.thermal};
}

/// Rays serve pictures: what a single node receives by them is noisy. Their cost hardly depends on the faces,
/// of which links between so many are too coarse or too many.
bool goes_by_rays(const Problem& problem) {
  constexpr std::size_t kManyFaces = 100000;
  const Options& options = problem.options;
  if (options.exchange != ExchangeBy::automatic) return options.exchange == ExchangeBy::rays;
  std::size_t faces = 0;
  for (const Piece& piece : problem.scene.pieces)
    faces += static_cast<std::size_t>(std::popcount(problem.scene.patch(piece.patch).sides));
  return error_is_of_picture(options) && faces > kManyFaces;
}

std::unique_ptr<Hierarchy> make_hierarchy(const Problem& problem) {
  if (goes_by_rays(problem))
    return std::make_unique<RayHierarchy>(ranks_of(problem.world), problem.scene, problem.ray_scene,
                                          problem.threads, oracle_parts(problem.options));
  return std::make_unique<LinkHierarchy>(ranks_of(problem.world), problem.scene, problem.ray_scene,
                                         problem.threads, oracle_parts(problem.options));
}

/// Collective. What each rank finds of its memory is its own; where to end all must agree.
ErrorGoal goal_of(const Problem& problem) {
  const Options& options = problem.options;
  std::uint64_t available = available_bytes(problem.world.host().size());
  problem.world.all_min(std::span(&available, 1));
  return {options.block_error ? 0 : options.target_error.value_or(kTargetError),
          options.block_error.value_or(0),
          options.memory.value_or(static_cast<std::uint64_t>(kMemoryShare * static_cast<double>(available)))};
}

/// All that the rounds depend on of what was chosen.
std::array<double, 9> choices_of(const Options& options, const ErrorGoal& goal, bool by_rays) {
  return {by_rays ? 1.0 : 0.0,
          goal.target,
          goal.block_error,
          options.tolerance.value_or(0),
          static_cast<double>(options.max_iterations),
          static_cast<double>(options.solver),
          static_cast<double>(options.oracle),
          static_cast<double>(error_of(options)),
          options.audit};
}

void say_closure(Log& log, const Closure& closure) {
  log.say(fmt::format("closure: row sums of a closed scene off by up to {:.2g} made 1 to within {:.2g}",
                      closure.defect_before, closure.defect_after));
  if (!closure.trusted)
    log.warn(fmt::format(
        "closure changes form factors by up to {:.2g}: some are missing or wrong, as in gaps that "
        "are narrow beside the nodes; ask for a smaller error",
        closure.largest_change));
}

void say_hierarchy(const Problem& problem, const Solution& solution) {
  const HierarchyStatistics& found = *solution.hierarchy;
  const HierarchyRound& last = found.rounds.back();
  problem.log.say(fmt::format("hierarchy: {}, {} leaves, in {} rounds{}; {:.2f} s", exchange_text(last),
                              last.leaves, found.rounds.size(),
                              found.stated ? fmt::format(", stated error {:.2g} %", 100 * *found.stated) : "",
                              solution.time.solve.wall));
}

}  // namespace

Solution solve_hierarchical(const Problem& problem) {
  const Options& options = problem.options;
  const EndCatcher catcher;
  Solution solution;

  // 1. What the camera sees, and elements where some are asked for.
  subdivide(problem, {}, solution);
  Stopwatch watch;

  // 2. The hierarchy, seen from the points of the pixels.
  const std::unique_ptr<Hierarchy> made = make_hierarchy(problem);
  Hierarchy& hierarchy = *made;
  std::vector<GatherPoint> points;
  if (options.camera)
    points =
        seen_points_of(hierarchy.tree(), *options.camera, options.supersample, solution.subdivided.raster);
  // The table of heat is of all surfaces, whatever a camera sees.
  const std::vector<std::uint32_t> probe_pixels =
      error_is_of_picture(options) ? choose_probes(hierarchy.tree(), points) : std::vector<std::uint32_t>{};
  std::vector<GatherPoint> probes;
  probes.reserve(probe_pixels.size());
  for (const std::uint32_t pixel : probe_pixels) probes.push_back(points[pixel]);
  hierarchy.set_importance_points(probes);
  hierarchy.handle_signals_by([&] { handle_signals(problem.world, options, problem.log); });
  RoundLimit limit(problem, static_cast<double>(points.size()));
  hierarchy.end_refinement_when([&] { return limit.is_time_to_end(); });

  // 3. Refined and solved in turn, until the error is expected to be the target's.
  ErrorGoal goal = goal_of(problem);
  goal.points = static_cast<double>(points.size());
  RoundFolder folder(problem.world, options,
                     rounds_identity(problem.ray_scene, hierarchy.tree(), hierarchy.leaves().unknowns(),
                                     probes, choices_of(options, goal, goes_by_rays(problem))),
                     [&](const std::string& sentence) { problem.log.warn(sentence); });
  const AuditSubject subject =
      error_is_of_picture(options)
          ? audit_picture(problem.scene,
                          draw_picture_places(problem.ray_scene, *options.camera, options.supersample,
                                              solution.subdivided.raster),
                          *options.camera, options.supersample)
          : audit_surfaces(problem.scene, options.thermal);
  std::optional<RoundPreview> preview;
  if (options.camera) preview.emplace(problem, hierarchy, solution.subdivided.raster, points);
  ControlledError controlled = control_error(problem, hierarchy, probes, subject, goal,
                                             {folder, limit, preview ? &*preview : nullptr});
  solution.hierarchy = std::move(controlled.statistics);
  solution.hierarchy->by_rays = !hierarchy.cut().empty();
  solution.audit = std::move(controlled.audit);
  solution.expected_error = solution.stated_error = solution.hierarchy->stated;
  if (!options.checkpoint.empty()) solution.checkpoint = folder.counts();
  solution.time.solve = watch.lap();
  say_hierarchy(problem, solution);
  say_checkpoint(problem, solution);
  if (hierarchy.closure()) say_closure(problem.log, *hierarchy.closure());
  balance_energy(problem, hierarchy, solution);
  solution.time.energy = watch.lap();

  // 4. Light of the elements and of each pixel.
  const GatherGoal gather_goal{solution.hierarchy->ray_error, hierarchy.mean_radiosity()};
  if (options.subdivision == Subdivision::transport) {
    solution.radiosity = hierarchy.radiosity();
    take_leaves(problem.world, hierarchy, points, solution.subdivided);
  } else {
    solution.radiosity =
        light_of_elements(hierarchy, solution.subdivided.mesh, gather_goal, problem.progress);
  }
  // Elements that the camera has made are as fine as its pixels.
  if (options.camera && options.subdivision != Subdivision::camera) {
    handle_signals(problem.world, options, problem.log);
    problem.progress.begin("gathering the picture");
    if (solution.hierarchy->by_rays && !probes.empty()) {
      PictureLight light = gather_filtered(
          problem, hierarchy, solution.subdivided.raster.width, points,
          {probe_pixels, controlled.probed, gather_goal.error, solution.hierarchy->errors.rays.value_or(0)});
      solution.pixel_irradiance = std::move(light.irradiance);
      solution.hierarchy->errors.picture = light.error;
    } else {
      solution.pixel_irradiance = hierarchy.gather(points, gather_goal, problem.progress);
    }
    problem.progress.end();
  }
  // Of rounds that were taken up from a checkpoint the radiosity does not know it.
  solution.radiosity->tolerance = solution.hierarchy->tolerance;
  solution.time.gather = watch.lap();
  if (!problem.sensors.receivers.empty())
    gather_receivers(problem, hierarchy.tree().elements(), hierarchy.radiosity().H, solution);
  sum_counts(problem.world, hierarchy, *solution.hierarchy);
  solution.converged = hierarchy.radiosity().converged;
  solution.goal_reached = solution.hierarchy->reached.value_or(!solution.hierarchy->ended_by);
  solution.stopped = solution.hierarchy->ended_by == RunLimit::signal && !solution.goal_reached;
  solution.instruction_set = instruction_set_in_use();
  return solution;
}

}  // namespace fluxel
