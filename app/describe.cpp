#include "app/describe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/rank_list.hpp"
#include "core/option_names.hpp"
#include "core/options.hpp"
#include "method/methods.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/launch_warnings.hpp"
#include "optics/luminaire_doubts.hpp"
#include "output/lighting_verdicts.hpp"
#include "output/report.hpp"
#include "output/scene_summary.hpp"
#include "output/stated_receivers.hpp"
#include "output/thermal_table.hpp"
#include "reference/receiver_doubts.hpp"
#include "scene/list_names.hpp"
#include "solver/channels.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

namespace {

void warn_of_escape(const RunRecord& record, Log& log) {
  // Heat goes where it will, and receivers may be all that a lamp shines on.
  if (record.options.thermal || !record.scene.receivers.empty()) return;
  if (nearly_all_escapes(*record.solution.energy))
    log.warn(
        "nearly all light meets no surface that receives it: lights emit from their fronts, which their "
        "vertices go round counter-clockwise; if they face away from the scene, reverse their vertices");
}

void warn_of_defect(const RunRecord& record, Log& log) {
  const Solution& solution = record.solution;
  if (!is_large_defect(*solution.energy)) return;
  log.warn(
      fmt::format("{:.3g} % of the emitted power is unaccounted for: form factors are missing or wrong "
                  "(elements too large for what is near them, or surfaces closer than {:.2g} m, which "
                  "count as one in a scene of this size); {}, or leave far surfaces out",
                  100 * largest_relative_defect(*solution.energy), least_gap(record.scene),
                  row_of(record.options.method).remedies.against_defect));
}

void describe_thermal(const RunRecord& record, Log& log) {
  const Solution& solution = record.solution;
  const EnergyBalance& energy = *solution.energy;
  double net = 0;
  std::vector<std::string> below_zero;
  for (const ThermalRow& row : solution.thermal) {
    net += row.net;
    if (row.below_zero) below_zero.push_back(row.group + (row.back ? " (back)" : ""));
  }
  log.say(thermal_text(solution.thermal, record.scene.temperature_unit));
  log.say(
      fmt::format("heat balance: net {:.6g} W = escaped {:.6g} W + on dark sides {:.6g} W + defect {:.2g} W",
                  net, energy.escaped.r, energy.dark.r, energy.defect.r));
  if (solution.heat_steps)
    log.say(fmt::format("convection: the air takes {:.6g} W from faces", energy.convected.r));
  log.say(fmt::format("table: {}", (std::filesystem::path(record.options.out) / "thermal.csv").string()));
  if (!below_zero.empty())
    log.warn(
        fmt::format("more heat is drawn than a surface at 0 K can take in, in {}: there is no such "
                    "temperature; raise heat_flux there",
                    list_names(below_zero)));
}

void describe_iteration(const Solution& solution, std::size_t ranks, Log& log) {
  const Radiosity& radiosity = *solution.radiosity;
  log.say(fmt::format(
      "solve: {}{}, {} in {}, error bound {:.2g} of the mean B (rms {:.2g}), residual {:.2g}; {:.2f} s",
      solver_text(radiosity.solver, ranks),
      solution.solver_reason.empty() ? "" : fmt::format(" ({})", solution.solver_reason),
      radiosity.iterations == 1 ? "1 iteration" : fmt::format("{} iterations", radiosity.iterations),
      radiosity.channels == 1 ? "one channel" : "three channels", radiosity.error_bound,
      largest_channel(radiosity.mean_square_bound), radiosity.residual, solution.time.solve.wall));
  if (solution.heat_steps)
    log.say(fmt::format(
        "convection: {} steps; the last one changed temperatures by up to {:.2g} K, and leaves {:.2g} of the "
        "mean B",
        solution.heat_steps->steps, solution.heat_steps->change, solution.heat_steps->error));
  if (radiosity.discretisation)
    log.say(fmt::format("discretisation error: about {:.2g} of the mean B (rms)",
                        largest_channel(*radiosity.discretisation)));
}

}  // namespace

void describe_scene(const Options& options, const Scene& scene, Log& log) {
  const SceneSummary summary = summarise(scene);
  const UnitNames units = unit_names(scene.units);
  log.say(fmt::format("scene: {} patches in {} pieces, {} materials, {} emitters, {}", scene.patches.size(),
                      scene.pieces.size(), scene.materials.size(), summary.emitters,
                      scene.statistics.closed ? "closed" : "open"));
  log.say(fmt::format("bounds: {:.6g},{:.6g},{:.6g} to {:.6g},{:.6g},{:.6g} m", summary.bounds[0].x,
                      summary.bounds[0].y, summary.bounds[0].z, summary.bounds[1].x, summary.bounds[1].y,
                      summary.bounds[1].z));
  if (options.thermal)
    log.say(fmt::format("thermal power: {:.6g} W emitted, {:.6g} W drawn by prescribed fluxes",
                        summary.emitted_power.r, summary.drawn_power.r));
  else
    log.say(fmt::format("emitted power: {:.6g}, {:.6g}, {:.6g} {} (--ke {}: Ke of OBJ files in {})",
                        summary.emitted_power.r, summary.emitted_power.g, summary.emitted_power.b, units.flux,
                        name_of(kKeNames, options.ke),
                        options.ke == KeMeaning::radiance ? units.radiance : units.exitance));
  if (!scene.luminaires.empty())
    log.say(fmt::format("luminaires: {} of {:.6g}, {:.6g}, {:.6g} {}", scene.luminaires.size(),
                        summary.luminaire_power.r, summary.luminaire_power.g, summary.luminaire_power.b,
                        units.flux));
  for (const std::string& note : scene.notes) log.say(fmt::format("note: {}", note));
  for (const std::string& warning : scene.warnings) log.warn(warning);
}

void describe_places(const Communicator& world, const RayScene& ray_scene, Log& log) {
  on_root(world, [&] {
    const LuminaireDoubts doubts = luminaire_doubts(ray_scene);
    for (const std::string& warning : doubts.warnings) log.warn(warning);
    if (doubts.note) log.say(fmt::format("note: {}", *doubts.note));
    for (const std::string& doubt : receiver_doubts(ray_scene)) log.warn(doubt);
  });
}

void describe_ranks(const Options& options, const std::vector<RankPlace>& places, Log& log) {
  for (const std::string& line : rank_list(places)) log.say(line);
  for (const std::string& warning : launch_warnings(places, options.threads)) log.warn(warning);
}

void describe_camera(const std::optional<Camera>& camera, const SceneInput& input, Log& log) {
  if (!camera || input.cameras.size() < 2) return;
  std::vector<std::string> names;
  for (const InputCamera& other : input.cameras)
    if (other.name) names.push_back(other.name->value);
  if (std::ranges::find(names, camera->name) == names.end()) return;  // of the command line, or a file
  log.say(fmt::format("camera: {}, of {} (--camera NAME takes another)", camera->name, list_names(names)));
}

void describe_solution(const RunRecord& record, Log& log) {
  const Solution& solution = record.solution;
  if (solution.matrix) describe_iteration(solution, record.places.size(), log);
  if (!solution.energy) return;
  const EnergyBalance& energy = *solution.energy;
  if (!std::isfinite(largest_relative_defect(energy))) {
    log.say("energy: not finite");
    return;
  }
  const auto percent = [&](const Rgb& power) {
    const double emitted = energy.emitted.r + energy.emitted.g + energy.emitted.b;
    return 100 * (power.r + power.g + power.b) / emitted;
  };
  log.say(fmt::format(
      "energy: absorbed {:.2f} %, escaped {:.2f} %, on dark sides {:.2f} %, defect {:.2f} % (rays: +-{:.2f} "
      "%)",
      percent(energy.absorbed), percent(energy.escaped), percent(energy.dark), percent(energy.defect),
      percent(energy.sampling_error)));
  warn_of_escape(record, log);
  warn_of_defect(record, log);
}

void describe_receivers(const RunRecord& record, Log& log) {
  for (const auto& [receiver, light, figures, unreached] : stated_receivers(record))
    log.say(fmt::format("receiver {}: mean {} {}, min {}, {}", receiver.name, stated_text(figures.mean),
                        unit_of(receiver, record.scene.units), stated_text(figures.min),
                        figures.U0 ? "U0 " + stated_text(*figures.U0) : "all is dark"));
  for (const ObserverRating& of : observer_ratings(record))
    log.say(fmt::format("observer {}: {}", of.glare.observer,
                        of.rating ? "UGR " + stated_text({of.rating->UGR, of.rating->error})
                        : of.glare.sources.weighted > 0 ? "no UGR: the background is darker than its error"
                                                        : "nothing glares"));
  if (record.solution.end != RunEnd::solution) return;
  for (const TaskVerdict& task : task_verdicts(record)) {
    log.say(fmt::format("task {}: {}", task.name, verdict_text(task.verdict)));
    for (const Criterion& of : task.criteria)
      log.say(fmt::format("  {:<12} {:<16} {:<4} {:>7.4g} required, {} found: {}", of.zone, of.of,
                          of.quantity, of.required, of.found ? stated_text(*of.found) : "none",
                          verdict_text(of.verdict)));
  }
}

void describe_outputs(bool written, const RunRecord& record, Log& log) {
  const Options& options = record.options;
  const std::filesystem::path out = options.out;
  if (!written) {
    log.warn("the radiosity is not finite: neither picture nor solution is written");
    return;
  }
  if (options.camera) log.say(fmt::format("picture: {} (and image.exr)", (out / "image.png").string()));
  if (options.method == Method::view) return;
  log.say(fmt::format("solution: {}", (out / "solution.ply").string()));
  if (options.thermal) describe_thermal(record, log);
}

}  // namespace fluxel
