#include "app/report.hpp"

#include <cmath>

#include "app/command_line.hpp"
#include "app/describe.hpp"
#include "app/json_parts.hpp"
#include "app/version_text.hpp"
#include "core/file.hpp"
#include "core/hash.hpp"

namespace fluxel {

namespace {

Json activity_json(const Activity& activity) {
  return {{"busy_s", activity.busy_seconds},
          {"waiting_s", activity.waiting_seconds},
          {"message_s", activity.message_seconds},
          {"messages_sent", activity.messages_sent},
          {"bytes_sent", activity.bytes_sent},
          {"strips", activity.strips},
          {"tiles", activity.tiles}};
}

Json ranks_json(const RunReport& report) {
  Json ranks = Json::array();
  for (std::size_t rank = 0; rank < report.places.size(); ++rank) {
    const RankPlace& place = report.places[rank];
    Json json{{"host", place.host}, {"cpus", place.cpus}, {"threads", place.threads}};
    const auto add = [&](const char* phase, const DealtTiles& dealt) {
      if (!dealt.of_ranks.empty()) json[phase] = activity_json(dealt.of_ranks[rank]);
    };
    add("visibility", report.visibility_dealt);
    add("corrections", report.form_factors.corrections_dealt);
    ranks.push_back(json);
  }
  return ranks;
}

/// One of the two times of every phase.
Json time_json(const PhaseTimes& time, double PhaseTime::*kind) {
  return {{"load", time.load.*kind},
          {"subdivision", time.subdivision.*kind},
          {"forecast", time.forecast.*kind},
          {"visibility", time.visibility.*kind},
          {"form_factors", time.form_factors.*kind},
          {"gather", time.gather.*kind},
          {"preview", time.preview.*kind},
          {"solve", time.solve.*kind},
          {"image", time.image.*kind},
          {"estimate", time.estimate.*kind},
          {"total", time.total.*kind}};
}

Json scene_json(const RunReport& report) {
  const SceneFacts& facts = report.facts;
  Json json{{"faces_read", facts.faces_read},
            {"degenerate_faces", facts.degenerate_faces},
            {"nonplanar_faces", facts.nonplanar_faces},
            {"merged_patches", facts.merged_patches},
            {"pieces", report.pieces},
            {"materials", report.materials},
            {"emitters", report.emitters},
            {"emitted_power", triple(report.emitted_power)},
            {"bounds_m", Json::array({triple(report.bounds[0]), triple(report.bounds[1])})},
            {"mesh_closed", facts.closed},
            {"convex", facts.convex},
            {"components", facts.components},
            {"closed_components", facts.closed_components},
            {"boundary_edges", facts.boundary_edges},
            {"nonmanifold_edges", facts.nonmanifold_edges},
            {"flipped_edges", facts.flipped_edges},
            {"coplanar_overlaps", facts.coplanar_overlaps},
            {"covered_area_m2", facts.covered_area},
            {"cut_patches", facts.cut_patches},
            {"sealed_sides", facts.sealed_sides}};
  if (report.closed) json["closed"] = *report.closed;
  return json;
}

Json form_factor_json(const RunReport& report) {
  const FormFactorFacts& facts = report.form_factors;
  Json json{{"row_sum_max", facts.row_sum_max},
            {"closure_defect_rms", facts.closure_defect_rms},
            {"row_sum_max_solved", report.row_sums.largest},
            {"rows_amplifying", report.row_sums.amplifying.size()},
            {"rows_capped", facts.capped_rows},
            {"near_pairs", facts.corrections.near_pairs},
            {"partial_pairs", facts.corrections.partial_pairs},
            {"rays", facts.corrections.rays},
            {"bytes", facts.correction_bytes}};
  if (facts.closure)
    json["closure"] = {{"defect_before", facts.closure->defect_before},
                       {"defect_after", facts.closure->defect_after},
                       {"largest_change", facts.closure->largest_change},
                       {"sweeps", facts.closure->sweeps},
                       {"trusted", facts.closure->trusted}};
  return json;
}

Json solve_json(const RunReport& report) {
  const Radiosity& radiosity = *report.radiosity;
  Json solve{{"solver", solver_text(report)},
             {"channels", radiosity.channels},
             {"iterations", radiosity.iterations},
             {"residual", number(radiosity.residual)},
             {"error_bound", number(radiosity.error_bound)},
             {"error_bound_rgb", triple(radiosity.largest_bound)},
             {"error_bound_rms_rgb", triple(radiosity.mean_square_bound)},
             {"converged", radiosity.converged},
             {"gathers", report.gathered.gathers},
             {"gathered_bytes_a_node", report.gathered.bytes},
             {"gather_wait_s", report.gathered.wait_seconds},
             {"isa", report.instruction_set}};
  if (report.options.device != Device::cpu) solve["gpu_ranks"] = report.form_factors.gpu_ranks;
  if (!report.solver_reason.empty()) solve["why"] = report.solver_reason;
  if (radiosity.discretisation) solve["discretisation_error_rgb"] = triple(*radiosity.discretisation);
  if (!radiosity.converged) solve["cause"] = radiosity.cause;
  return solve;
}

Json hierarchy_json(const RunReport& report) {
  const HierarchyFacts& facts = *report.hierarchy;
  const auto known = [](const std::optional<double>& value) {
    return value ? number(*value) : Json(nullptr);
  };
  Json rounds = Json::array();
  for (const HierarchyRound& round : facts.rounds)
    rounds.push_back({{"block_error", round.block_error},
                      {"blocks", round.links},
                      {"nodes", round.nodes},
                      {"leaves", round.leaves},
                      {"iterations", round.iterations},
                      {"change", known(round.change)},
                      {"discretisation", known(round.discretisation)},
                      {"refine_s", round.refine_seconds},
                      {"solve_s", round.solve_seconds}});
  const HierarchyRound& last = facts.rounds.back();
  const auto leaves = static_cast<double>(last.leaves);
  return {
      {"rounds", rounds},
      {"rounds_resumed", facts.rounds_resumed},
      {"errors",
       {{"discretisation", known(facts.errors.discretisation)},
        {"visibility", facts.errors.visibility},
        {"iteration", number(facts.errors.iteration)}}},
      {"chosen",
       {{"block_error", last.block_error}, {"ray_error", facts.ray_error}, {"tolerance", facts.tolerance}}},
      {"reached", facts.reached},
      {"fits_memory", facts.fits},
      {"bytes_max", facts.bytes},
      {"leaf_pairs", leaves * (leaves - 1) / 2},
      {"node_pairs_looked_at", facts.pairs},
      {"shafts", facts.shafts},
      {"contours", facts.contours},
      {"rays", facts.rays},
      {"gather_rays", facts.gather_rays}};
}

Json energy_json(const EnergyBalance& energy) {
  return {{"emitted", triple(energy.emitted)},
          {"absorbed", triple(energy.absorbed)},
          {"escaped", triple(energy.escaped)},
          {"dark", triple(energy.dark)},
          {"defect", triple(energy.defect)},
          {"defect_relative", number(largest_relative_defect(energy))},
          {"sampling_error", triple(energy.sampling_error)}};
}

Json estimate_json(const RunReport& report) {
  const ErrorEstimate& estimate = *report.error_estimate;
  Json json{{"convergence_rgb", triple(report.radiosity->mean_square_bound)},
            {"elements", estimate.elements}};
  if (!estimate.why_none.empty()) {
    json["why_none"] = estimate.why_none;
    return json;
  }
  const RefinementError& discretisation = estimate.discretisation;
  json["discretisation_rgb"] = triple(discretisation.error);
  json["order"] = discretisation.order ? number(*discretisation.order) : Json(nullptr);
  json["survival"] = number(discretisation.survival);
  json["alignment"] = number(discretisation.alignment);
  return json;
}

Json thermal_json(const std::vector<ThermalRow>& rows) {
  Json json = Json::array();
  for (const ThermalRow& row : rows)
    json.push_back({{"group", row.group},
                    {"side", row.back ? "back" : "front"},
                    {"area_m2", row.area},
                    {"temperature_K", number(row.temperature)},
                    {"emissivity", row.emissivity},
                    {"emitted_W", number(row.emitted)},
                    {"absorbed_W", number(row.absorbed)},
                    {"net_W", number(row.net)},
                    {"error_W", number(row.error)}});
  return json;
}

}  // namespace

void write_report(const std::filesystem::path& file, const RunReport& report) {
  Json options = Json::object();
  for (const auto& [name, value] : describe(report.options)) options[name] = value;

  Json json{{"patches", report.patches},
            {"elements", report.elements},
            {"unknowns", report.unknowns},
            {"ranks", report.places.size()},
            {"threads", report.places.front().threads},
            {"options", options},
            {"version", version_text()},
            {"time_s", time_json(report.time, &PhaseTime::wall)},
            {"cpu_s", time_json(report.time, &PhaseTime::processor)},
            {"scene", scene_json(report)},
            {"subdivision", {{"deepest_tree", report.deepest}, {"max_edge_m", number(report.max_edge)}}}};
  json["visibility"] = {{"pairs", report.forecast.pairs}};
  if (report.visibility) {
    const VisibilityCounts& visibility = *report.visibility;
    json["visibility"].update(
        {{"rays", visibility.rays},
         {"bytes", visibility.store_bytes},
         {"message_bytes", visibility.message_bytes},
         {"tiles_uniform", visibility.tiles_uniform},
         {"tiles_mixed", visibility.tiles_mixed},
         {"tiles_resumed", visibility.tiles_resumed},
         {"tiles_computed", visibility.tiles_uniform + visibility.tiles_mixed - visibility.tiles_resumed}});
    if ((report.visibility_makers & kMadeByGpu) != 0)
      json["visibility"]["gpu"] = {{"names", report.gpus},
                                   {"ranks", report.gpu_ranks},
                                   {"tiles", visibility.device.tiles},
                                   {"verified_pairs", visibility.device.verified_pairs},
                                   {"differing_bits", visibility.device.differing_bits},
                                   {"processor_too", (report.visibility_makers & kMadeByProcessor) != 0}};
  }
  if (report.checkpoint)
    json["checkpoint"] = {{"files", report.checkpoint->files},
                          {"bytes", report.checkpoint->bytes},
                          {"writes", report.checkpoint->writes},
                          {"seconds", report.checkpoint->seconds}};
  if (report.radiosity) {
    json["form_factor"] = form_factor_json(report);
    json["solve"] = solve_json(report);
    json["energy"] = energy_json(report.energy);
    if (report.options.thermal) json["thermal"] = thermal_json(report.thermal);
  }
  if (report.hierarchy) json["hierarchy"] = hierarchy_json(report);
  if (report.error_estimate) json["error_estimate"] = estimate_json(report);
  if (report.exposure) json["image"] = {{"exposure_stops", *report.exposure}};
  json["memory"] = {{"predicted_bytes_max", report.forecast.bytes},
                    {"peak_rss_bytes_max", report.peak_bytes}};
  if (report.radiosity) json["memory"]["pss_bytes_sum"] = report.held_bytes;
  if (!report.hierarchy)
    json["forecast"] = {{"visibility_s", report.forecast.visibility_seconds},
                        {"tiles_mixed_fraction", report.forecast.mixed_tiles},
                        {"visibility_bytes", report.forecast.store_bytes}};
  if (!report.phases.empty()) json["forecasts"] = forecasts_json(report.phases);
  json["hash"] = {{"elements", hash_text(report.elements_hash)}};
  if (report.visibility) json["hash"]["visibility"] = hash_text(report.visibility_hash);
  json["ranks_detail"] = ranks_json(report);
  json["notes"] = report.notes;
  json["warnings"] = report.warnings;
  write_bytes_atomically(file, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace fluxel
