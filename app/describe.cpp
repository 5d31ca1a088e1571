#include "app/describe.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <limits>
#include <map>
#include <vector>

#include "app/option_names.hpp"
#include "app/rank_list.hpp"
#include "mpi_master/launch_warnings.hpp"
#include "scene/text_check.hpp"
#include "solver/channels.hpp"
#include "subdivision/bisection.hpp"

namespace fluxel {

namespace {

std::array<glm::dvec3, 2> world_bounds(const Scene& scene) {
  glm::dvec3 low(scene.extent), high(-scene.extent);
  for (const Patch& patch : scene.patches)
    for (std::uint32_t c = 0; c < patch.outline.corners; ++c) {
      low = glm::min(low, patch.outline.corner[c]);
      high = glm::max(high, patch.outline.corner[c]);
    }
  return {low + scene.origin, high + scene.origin};
}

/// Names the groups of the rows that amplify, most rows first.
std::string amplifying_groups(const Scene& scene, const ElementView& mesh,
                              const std::vector<std::size_t>& rows) {
  std::map<std::string, std::size_t> count;
  for (const std::size_t row : rows) {
    const Element& element = mesh.elements[row % mesh.elements.size()];
    ++count[scene.groups[index(scene.patch(element.patch).group)]];
  }
  std::vector<std::pair<std::string, std::size_t>> groups(count.begin(), count.end());
  std::ranges::stable_sort(groups, std::greater{}, &std::pair<std::string, std::size_t>::second);
  std::string text;
  for (std::size_t k = 0; k < std::min<std::size_t>(groups.size(), 5); ++k)
    text += fmt::format("{}{} ({})", k == 0 ? "" : ", ", groups[k].first, groups[k].second);
  return groups.size() > 5 ? text + ", ..." : text;
}

void warn_of_defect(const Scene& scene, const Teller& teller, RunReport& report) {
  if (!is_large_defect(report.energy)) return;
  // Twice Embree's uncertainty, which visibility takes as one plane.
  const double least_gap = 8 * scene.extent * static_cast<double>(std::numeric_limits<float>::epsilon());
  teller.warn(
      report,
      fmt::format("{:.3g} % of the emitted power is unaccounted for: form factors are missing or wrong "
                  "(elements too large for what is near them, or surfaces closer than {:.2g} m, which "
                  "count as one in a scene of this size); use a smaller --max-edge or --closure, or "
                  "leave far surfaces out",
                  100 * largest_relative_defect(report.energy), least_gap));
}

void describe_thermal(const Teller& teller, RunReport& report) {
  double net = 0;
  std::vector<std::string> below_zero;
  for (const ThermalRow& row : report.thermal) {
    net += row.net;
    if (row.below_zero) below_zero.push_back(row.group + (row.back ? " (back)" : ""));
  }
  teller.say("{}", thermal_text(report.thermal));
  teller.say("heat balance: net {:.6g} W = escaped {:.6g} W + on dark sides {:.6g} W + defect {:.2g} W", net,
             report.energy.escaped.r, report.energy.dark.r, report.energy.defect.r);
  teller.say("table: {}", (std::filesystem::path(report.options.out) / "thermal.csv").string());
  if (!below_zero.empty())
    teller.warn(report,
                fmt::format("more heat is drawn than a surface at 0 K can take in, in {}: there is no such "
                            "temperature; raise heat_flux there",
                            list_names(below_zero)));
}

}  // namespace

void describe_scene(const Scene& scene, const Teller& teller, RunReport& report) {
  report.facts = scene.facts;
  report.patches = scene.patches.size();
  report.pieces = scene.pieces.size();
  report.materials = scene.materials.size();
  report.notes = scene.notes;
  report.emitters = static_cast<std::size_t>(std::ranges::count_if(
      scene.patches, [&](const Patch& patch) { return scene.material(patch).emits(); }));
  report.bounds = world_bounds(scene);
  Rgb drawn(0);
  for (const Piece& piece : scene.pieces) {
    const Patch& patch = scene.patch(piece.patch);
    const Material& material = scene.material(patch);
    const Rgb power = area(piece.outline) *
                      ((patch.sides & kBack) != 0 ? material.E + material.back_exitance() : material.E);
    report.emitted_power += glm::max(power, Rgb(0));
    drawn -= glm::min(power, Rgb(0));
  }
  teller.say("scene: {} patches in {} pieces, {} materials, {} emitters, {}", report.patches, report.pieces,
             report.materials, report.emitters, scene.facts.closed ? "closed" : "open");
  teller.say("bounds: {:.6g},{:.6g},{:.6g} to {:.6g},{:.6g},{:.6g} m", report.bounds[0].x, report.bounds[0].y,
             report.bounds[0].z, report.bounds[1].x, report.bounds[1].y, report.bounds[1].z);
  if (report.options.thermal)
    teller.say("thermal power: {:.6g} W emitted, {:.6g} W drawn by prescribed fluxes", report.emitted_power.r,
               drawn.r);
  else
    teller.say("emitted power: {:.6g}, {:.6g}, {:.6g} W (Ke read as {})", report.emitted_power.r,
               report.emitted_power.g, report.emitted_power.b,
               report.options.ke == KeMeaning::radiance ? "radiance, times pi" : "exitance");
  for (const std::string& note : scene.notes) teller.say("note: {}", note);
}

void describe_ranks(const Teller& teller, RunReport& report) {
  for (const std::string& line : rank_list(report.places)) teller.say("{}", line);
  for (const std::string& warning : launch_warnings(report.places, report.options.threads))
    teller.warn(report, warning);
}

void describe_checkpoint(const Teller& teller, const RunReport& report) {
  teller.say("checkpoint: {} files, {:.3g} GiB in {}, written in {:.2f} s", report.checkpoint->files,
             static_cast<double>(report.checkpoint->bytes) * 0x1p-30, report.options.checkpoint,
             report.checkpoint->seconds);
}

void warn_of_device_failures(const char* phase, std::span<const DeviceFailure> failures, const Teller& teller,
                             RunReport& report) {
  if (failures.empty()) return;
  teller.warn(report,
              fmt::format("GPUs of {} ranks have failed in the {}, and processors went on: {} (rank {})",
                          failures.size(), phase, failures.front().reason, failures.front().rank));
}

void describe_form_factors(const Teller& teller, RunReport& report) {
  const FormFactorFacts& facts = report.form_factors;
  teller.say(
      "form factors: {} pairs by contour, {} partly visible, {:.4g} rays, {:.3g} GiB; row sums up to {:.5g}, "
      "defect {:.2g} (rms){}; {:.2f} s",
      facts.corrections.near_pairs, facts.corrections.partial_pairs,
      static_cast<double>(facts.corrections.rays), static_cast<double>(facts.correction_bytes) * 0x1p-30,
      facts.row_sum_max, facts.closure_defect_rms,
      // A row above 1 by its rounding alone is not worth a word.
      facts.capped_rows > 0 && facts.row_sum_max > 1.001
          ? fmt::format(", {} rows above 1 scaled down", facts.capped_rows)
          : "",
      report.time.form_factors.wall);
  if (facts.gpu_ranks < report.gpu_ranks)
    teller.warn(
        report,
        fmt::format("the processor makes the solve's products of {} of {} ranks with a GPU: {}",
                    report.gpu_ranks - facts.gpu_ranks, report.gpu_ranks, facts.without_gpu.front().reason));
  if (!facts.closure) return;
  const Closure& closure = *facts.closure;
  teller.say("closure: defect {:.2g} to {:.2g} in {} sweeps, entries changed by at most {:.2g}",
             closure.defect_before, closure.defect_after, closure.sweeps, closure.largest_change);
  if (!closure.trusted)
    teller.warn(report,
                fmt::format("the closure is not to be trusted: it changes form factors by up to {:.2g} and "
                            "leaves a defect of {:.2g} after {} sweeps (form factors are missing or wrong; "
                            "use smaller elements)",
                            closure.largest_change, closure.defect_after, closure.sweeps));
}

void warn_of_amplifying_rows(const Scene& scene, const ElementView& mesh, const Teller& teller,
                             RunReport& report) {
  const RowSums& row_sums = report.row_sums;
  if (row_sums.amplifying.empty()) return;
  // A prescribed flux reflects all, so that rounding makes its rows amplify: no harm while there is a bound.
  if (report.options.thermal && row_sums.weights) return;
  teller.warn(report,
              fmt::format("reflectance times the form factors' row sum reaches 1 in {} rows (largest row sum "
                          "{:.4g}), in {}",
                          row_sums.amplifying.size(), row_sums.largest,
                          amplifying_groups(scene, mesh, row_sums.amplifying)));
}

std::string solver_text(const RunReport& report) {
  const Solver solver = report.radiosity->solver;
  const bool in_blocks = solver == Solver::gauss_seidel && report.places.size() > 1;
  return in_blocks ? "block gauss-seidel, jacobi coupling between ranks" : name_of(kSolverNames, solver);
}

void describe_solution(const Scene& scene, const Teller& teller, RunReport& report) {
  const Radiosity& radiosity = *report.radiosity;
  const EnergyBalance& energy = report.energy;
  teller.say(
      "solve: {}{}, {} in {}, error bound {:.2g} of the mean B (rms {:.2g}), residual {:.2g}; {:.2f} s",
      solver_text(report), report.solver_reason.empty() ? "" : fmt::format(" ({})", report.solver_reason),
      radiosity.iterations == 1 ? "1 iteration" : fmt::format("{} iterations", radiosity.iterations),
      radiosity.channels == 1 ? "one channel" : "three channels", radiosity.error_bound,
      largest_channel(radiosity.mean_square_bound), radiosity.residual, report.time.solve.wall);
  if (radiosity.discretisation)
    teller.say("discretisation error: about {:.2g} of the mean B (rms)",
               largest_channel(*radiosity.discretisation));
  if (!std::isfinite(largest_relative_defect(energy))) {
    teller.say("energy: not finite");
    return;
  }
  const auto percent = [&](const Rgb& power) {
    const double emitted = energy.emitted.r + energy.emitted.g + energy.emitted.b;
    return 100 * (power.r + power.g + power.b) / emitted;
  };
  teller.say(
      "energy: absorbed {:.2f} %, escaped {:.2f} %, on dark sides {:.2f} %, defect {:.2f} % (rays: +-{:.2f} "
      "%)",
      percent(energy.absorbed), percent(energy.escaped), percent(energy.dark), percent(energy.defect),
      percent(energy.sampling_error));
  warn_of_defect(scene, teller, report);
}

void describe_estimate(const Teller& teller, const RunReport& report) {
  const ErrorEstimate& estimate = *report.error_estimate;
  if (!estimate.why_none.empty()) {
    teller.say("no error estimate: {}", estimate.why_none);
    return;
  }
  teller.say("error estimate: elements {:.2g} %, iteration at most {:.2g} % of the mean B (rms); {:.2f} s",
             100 * largest_channel(estimate.discretisation.error),
             100 * largest_channel(report.radiosity->mean_square_bound), report.time.estimate.wall);
}

void describe_outputs(bool written, const Teller& teller, RunReport& report) {
  const std::filesystem::path out = report.options.out;
  if (!written) {
    teller.warn(report, "the radiosity is not finite: neither picture nor solution is written");
    return;
  }
  if (report.options.camera) teller.say("picture: {} (and image.exr)", (out / "image.png").string());
  teller.say("solution: {}", (out / "solution.ply").string());
  if (report.options.thermal) describe_thermal(teller, report);
}

}  // namespace fluxel
