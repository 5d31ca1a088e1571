#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>
#include <utility>

#include "core/file.hpp"
#include "core/options.hpp"
#include "core/signals.hpp"
#include "method/bake.hpp"
#include "method/element_light.hpp"
#include "method/error_control.hpp"
#include "method/gathered_picture.hpp"
#include "method/handle_signals.hpp"
#include "method/idle_options.hpp"
#include "method/kept_links.hpp"
#include "method/measured_heat.hpp"
#include "method/methods.hpp"
#include "method/picture_light.hpp"
#include "method/receiver_light.hpp"
#include "method/relative_error.hpp"
#include "method/round_preview.hpp"
#include "method/say_checkpoint.hpp"
#include "method/seen_hierarchy.hpp"
#include "method/smooth_edges.hpp"
#include "method/subdivide.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/steps/side_view_job.hpp"
#include "solver/closure.hpp"
#include "visibility/instruction_set.hpp"

namespace fluxel {

namespace {

/// Of the root, for everybody.
void broadcast(const Communicator& world, std::vector<SideSample>& samples) {
  const auto bytes = std::as_bytes(std::span(samples));
  Bytes message(bytes.begin(), bytes.end());
  world.broadcast(message);
  samples.resize(message.size() / sizeof(SideSample));
  if (!samples.empty()) std::memcpy(samples.data(), message.data(), message.size());
}

/// Collective.
void trace_samples(const Problem& problem, const ElementMesh& mesh, std::span<SideSample> samples) {
  std::vector<std::uint32_t> sides;
  sides.reserve(samples.size());
  for (const SideSample& sample : samples) sides.push_back(sample.unknown);
  const std::vector<SideView> views =
      views_of_sides(problem.world, problem.ray_scene, problem.scene, mesh, sides, problem.threads);
  for (std::size_t k = 0; k < samples.size(); ++k) samples[k].view = views[k];
}

/// Collective: where the power of the leaves goes, and their light; on the root.
void balance_energy(const Problem& problem, const Hierarchy& hierarchy, Solution& solution) {
  const bool is_root = problem.world.is_root();
  LeafLight light;
  std::vector<SideSample> samples;
  if (is_root) {
    light = hierarchy.leaf_light();
    samples = choose_sides(light.leaves.unknowns(), light.radiosity.B);
  }
  broadcast(problem.world, samples);
  {
    const ElementMesh mesh = hierarchy.tree().elements();
    trace_samples(problem, mesh, samples);
    if (is_root && problem.options.thermal)
      solution.thermal = thermal_rows(problem.scene, mesh.elements, light.leaves.unknowns(), light.radiosity,
                                      light.row_sums);
  }
  solution.closed = is_closed(samples);
  if (!is_root) return;
  const Unknowns& unknowns = light.leaves.unknowns();
  solution.energy = energy_balance(unknowns, light.radiosity, samples, luminaire_escape(problem.ray_scene));
  const std::vector<double>& sums = light.own_row_sums;
  solution.form_factor_sums = {sums.empty() ? 0 : *std::ranges::max_element(sums),
                               closure_defect_rms(unknowns, sums, samples), hierarchy.closure()};
  solution.row_sums = std::move(light.row_sums);
  if (problem.options.subdivision == Subdivision::transport) solution.radiosity = std::move(light.radiosity);
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

/// Of what has been made of the rays of many pixels, where that is worse than was allowed.
void take_picture_error(double error, double target, Solution& solution) {
  HierarchyStatistics& found = *solution.hierarchy;
  found.errors.picture = error;
  const double allowed = found.errors.rays.value_or(0);
  if (!found.stated || error <= allowed) return;
  found.stated = std::sqrt(*found.stated * *found.stated + error * error - allowed * allowed);
  solution.expected_error = solution.stated_error = found.stated;
  if (found.reached == true && *found.stated > target) found.reached.reset();
}

/// Of pixels that show the leaves, by what is known of the probes; of other elements nothing is.
void take_element_error(const SeenHierarchy& seen, const ProbedLight& probed, bool of_leaves, double target,
                        Solution& solution) {
  HierarchyStatistics& found = *solution.hierarchy;
  const NodeTree& tree = seen.hierarchy->tree();
  if (of_leaves && mean_of_colours(probed.mean) > 0) {
    const std::vector<Rgb> of_nodes = seen.hierarchy->radiosity_of_nodes();
    std::vector<Rgb> B;
    for (const GatherPoint& probe : seen.probes)
      B.push_back(of_nodes[tree.leaf_below(probe.face, probe.position)]);
    const Rgb square = glm::max(Rgb(0), mean_square(B, probed.B) - probed.noise);
    take_picture_error(root_over_mean(square, probed.mean), target, solution);
    if (target > 0 && found.stated && *found.stated > target) found.reached = false;
  } else {
    found.stated.reset();
    found.reached.reset();
    solution.expected_error.reset();
    solution.stated_error.reset();
  }
}

/// What has no effect where the scene and not --exchange has chosen rays; idle_reason says the rest.
void say_idle_by_rays(const Problem& problem) {
  const Options& options = problem.options;
  if (options.exchange != ExchangeBy::automatic) return;
  if (options.keep_links)
    problem.log.warn(
        "--keep-links: light goes by rays, which leave no links to keep (--exchange links has them)");
  if (options.solver != Solver::automatic)
    problem.log.warn(
        "--solver: light goes by rays, whose rows are not symmetric: Jacobi's iteration solves "
        "(--exchange links has the choice)");
}

/// Whether what is stated is no more than what was asked for; where nothing is, whether nothing has ended the
/// rounds early.
bool has_reached(const HierarchyStatistics& found, double target) {
  if (found.reached) return *found.reached;
  return found.stated && target > 0 ? *found.stated <= target : !found.ended_by;
}

/// Collective: whether, of the light of luminaires, which faces may meet in spots of any size, more power is
/// missing than the target allows of the error.
bool loses_light(const Problem& problem, double target, const Solution& solution) {
  if (problem.scene.luminaires.empty() || target == 0) return false;
  double missing = 0;
  if (problem.world.is_root()) {
    const EnergyBalance& energy = *solution.energy;
    for (int c = 0; c < kChannels; ++c)
      if (energy.emitted[c] > 0)
        missing = std::max(missing,
                           (std::abs(energy.defect[c]) - 3 * energy.sampling_error[c]) / energy.emitted[c]);
  }
  problem.world.all_max(std::span(&missing, 1));
  if (missing <= target) return false;
  problem.log.warn(
      fmt::format("{:.2g} % of the power is missing or too much, more than the target of {:.2g} %: light of "
                  "luminaires close to surfaces",
                  100 * missing, 100 * target));
  return true;
}

/// Collective: the light of each pixel.
void gather_pixels(const Problem& problem, const SeenHierarchy& seen, const ProbedLight& probed,
                   const RoundLimit& limit, double ray_error, double target, Solution& solution) {
  handle_signals(problem.world, problem.options, problem.log);
  Hierarchy& hierarchy = *seen.hierarchy;
  const int width = solution.subdivided.raster.width;
  const double allowed = solution.hierarchy->errors.rays.value_or(0);
  constexpr double kTries = 2;  // as many pictures of all pixels
  const bool has_time = limit.has_time_for(kTries * static_cast<double>(seen.points.size()), ray_error);
  const PictureGoal goal{seen.probe_pixels, probed, ray_error, allowed, has_time};
  const bool cached = problem.options.picture == PictureFrom::cached;
  // Of what is dark nothing is relative to its mean.
  const bool is_known = !seen.probes.empty() && allowed > 0 && mean_of_colours(probed.mean) > 0;
  if (is_known && (seen.by_rays || cached)) {
    PictureLight light = (cached ? gather_cached : gather_each)(problem, hierarchy, width, seen.points, goal);
    if (light.error) take_picture_error(*light.error, target, solution);
    take_picture(std::move(light), solution);
  } else {
    problem.progress.begin(kGatheringPicture);
    take_picture({hierarchy.gather(seen.points, {ray_error, hierarchy.mean_radiosity()}, problem.progress),
                  {},
                  0,
                  0,
                  ray_error},
                 solution);
    problem.progress.end();
  }
  smooth_gathered_edges(problem, hierarchy, solution);
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
  const SeenHierarchy seen = see_hierarchy(problem, solution.subdivided.raster);
  Hierarchy& hierarchy = *seen.hierarchy;
  if (seen.by_rays) say_idle_by_rays(problem);
  const std::vector<GatherPoint>& points = seen.points;
  const std::vector<GatherPoint>& probes = seen.probes;
  const double picture = work_of_picture(options, seen);
  RoundLimit limit(problem, options.seconds, picture);
  const bool keeps_links = options.keep_links && !seen.by_rays && idle_reason("keep-links", options).empty();
  const std::uint64_t scene = keeps_links ? scene_of_links(problem, hierarchy) : 0;
  if (keeps_links) on_root(problem.world, [&] { require_writable_folder(links_folder(options.out)); });
  hierarchy.end_refinement_when([&] { return limit.is_time_to_end(); });

  // 3. Refined and solved in turn, until the error is expected to be the target's.
  const ErrorGoal goal = goal_of(problem, picture);
  RoundFolder folder(
      problem.world, options,
      options.checkpoint.empty()
          ? 0
          : rounds_identity(problem.ray_scene, hierarchy.tree(), LeafUnknowns(hierarchy.tree()).unknowns(),
                            probes, choices_of(options, goal, seen.by_rays)),
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
                                             {&folder, limit, preview ? &*preview : nullptr});
  solution.hierarchy = std::move(controlled.statistics);
  solution.hierarchy->by_rays = hierarchy.by_rays();
  solution.audit = std::move(controlled.audit);
  solution.expected_error = solution.stated_error = solution.hierarchy->stated;
  if (!options.checkpoint.empty()) solution.checkpoint = folder.counts();
  solution.time.solve = watch.lap();
  say_hierarchy(problem, solution);
  say_checkpoint(problem, solution);
  if (hierarchy.closure()) say_closure(problem.log, *hierarchy.closure());
  balance_energy(problem, hierarchy, solution);
  if (loses_light(problem, goal.target, solution)) {
    solution.goal_reached = false;
    solution.hierarchy->reached = false;
  }
  solution.time.energy = watch.lap();

  // 4. Light of the elements and of each pixel.
  const std::optional<double> stated_before = solution.hierarchy->stated;
  const GatherGoal gather_goal{solution.hierarchy->ray_error, hierarchy.mean_radiosity()};
  if (options.subdivision == Subdivision::transport) {
    take_leaves(problem.world, hierarchy.tree(), points, solution.subdivided);
  } else {
    solution.radiosity =
        light_of_elements(hierarchy, solution.subdivided.mesh, gather_goal, problem.progress);
  }
  if (keeps_links)
    keep_links(
        problem, hierarchy, scene, solution.hierarchy->rounds,
        problem.world.is_root() ? std::span<const Rgb>(solution.radiosity->B) : std::span<const Rgb>());
  if (gathers_picture(options))
    gather_pixels(problem, seen, controlled.probed, limit, gather_goal.error, goal.target, solution);
  else if (options.camera && options.subdivision != Subdivision::camera)
    take_element_error(seen, controlled.probed, options.subdivision == Subdivision::transport, goal.target,
                       solution);
  if (solution.hierarchy->stated && solution.hierarchy->stated != stated_before)
    problem.log.say(fmt::format("stated error with that of the picture's rays: {:.2g} %",
                                100 * *solution.hierarchy->stated));
  if (bakes(options)) {
    hierarchy.scale_reflected(Rgb(1));  // the scale is of the points of one picture
    bake(problem, hierarchy, goal.target, solution);
  }
  // Of rounds that were taken up from a checkpoint the radiosity does not know it.
  if (solution.radiosity) solution.radiosity->tolerance = solution.hierarchy->tolerance;
  solution.time.gather = watch.lap();
  if (options.thermal)
    measure_heat(problem, hierarchy.tree().elements(), hierarchy.leaf_light().radiosity.H, solution);
  if (problem.sensors.has_meters())
    gather_receivers(problem, hierarchy.tree().elements(), hierarchy.leaf_light().radiosity.H, solution);
  sum_counts(problem.world, hierarchy, *solution.hierarchy);
  solution.converged = hierarchy.radiosity().converged;
  solution.goal_reached = solution.goal_reached && has_reached(*solution.hierarchy, goal.target);
  solution.stopped =
      solution.stopped || (solution.hierarchy->ended_by == RunLimit::signal && !solution.goal_reached);
  solution.instruction_set = instruction_set_in_use();
  return solution;
}

}  // namespace fluxel
