#include "output/report.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/file.hpp"
#include "core/hash.hpp"
#include "core/option_names.hpp"
#include "core/options.hpp"
#include "output/json_parts.hpp"
#include "output/lighting_verdicts.hpp"
#include "output/option_json.hpp"
#include "output/scene_summary.hpp"
#include "output/stated_receivers.hpp"
#include "output/version_text.hpp"
#include "scene/quantity_names.hpp"
#include "solver/unknowns.hpp"

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

Json ranks_json(const RunRecord& record) {
  const std::optional<MatrixStatistics>& matrix = record.solution.matrix;
  Json ranks = Json::array();
  for (std::size_t rank = 0; rank < record.places.size(); ++rank) {
    const RankPlace& place = record.places[rank];
    Json json{{"host", place.host}, {"cpus", place.cpus}, {"threads", place.threads}};
    const auto add = [&](const char* phase, const ScheduleRecord& schedule) {
      if (!schedule.of_ranks.empty()) json[phase] = activity_json(schedule.of_ranks[rank]);
    };
    if (matrix) add("visibility", matrix->visibility_schedule);
    if (matrix && matrix->form_factors) add("corrections", matrix->form_factors->corrections_schedule);
    ranks.push_back(json);
  }
  return ranks;
}

/// One of the two times of every phase that the run had.
Json time_json(const PhaseTimes& time, double PhaseTime::*kind) {
  Json json = Json::object();
  for (const auto& [name, phase] : kPhases)
    if ((time.*phase).wall > 0) json[name] = (time.*phase).*kind;
  return json;
}

Json scene_json(const RunRecord& record) {
  const Scene& scene = record.scene;
  const SceneStatistics& statistics = scene.statistics;
  const SceneSummary summary = summarise(scene);
  Json json{{"faces_read", statistics.faces_read},
            {"degenerate_faces", statistics.degenerate_faces},
            {"nonplanar_faces", statistics.nonplanar_faces},
            {"merged_patches", statistics.merged_patches},
            {"pieces", scene.pieces.size()},
            {"materials", scene.materials.size()},
            {"emitters", summary.emitters},
            {"units", scene.units == Units::photometric ? "photometric" : "radiometric"},
            {"emitted_power", triple(summary.emitted_power)},
            {"luminaires", scene.luminaires.size()},
            {"luminaire_power", triple(summary.luminaire_power)},
            {"bounds_m", Json::array({triple(summary.bounds[0]), triple(summary.bounds[1])})},
            {"mesh_closed", statistics.closed},
            {"convex", statistics.convex},
            {"components", statistics.components},
            {"closed_components", statistics.closed_components},
            {"boundary_edges", statistics.boundary_edges},
            {"nonmanifold_edges", statistics.nonmanifold_edges},
            {"flipped_edges", statistics.flipped_edges},
            {"coplanar_overlaps", statistics.coplanar_overlaps},
            {"covered_area_m2", statistics.covered_area},
            {"cut_patches", statistics.cut_patches},
            {"sealed_sides", statistics.sealed_sides}};
  if (record.solution.closed) json["closed"] = *record.solution.closed;
  return json;
}

Json form_factor_json(const Solution& solution) {
  Json json{{"row_sum_max", solution.form_factor_sums->row_sum_max},
            {"closure_defect_rms", solution.form_factor_sums->closure_defect_rms},
            {"row_sum_max_solved", solution.row_sums.largest},
            {"rows_amplifying", solution.row_sums.amplifying.size()}};
  if (const std::optional<Closure>& closure = solution.form_factor_sums->closure)
    json["closure"] = {{"defect_before", closure->defect_before},
                       {"defect_after", closure->defect_after},
                       {"largest_change", closure->largest_change},
                       {"sweeps", closure->sweeps},
                       {"trusted", closure->trusted}};
  if (!solution.matrix || !solution.matrix->form_factors) return json;
  const FormFactorStatistics& statistics = *solution.matrix->form_factors;
  json.update({{"rows_capped", statistics.capped_rows},
               {"near_pairs", statistics.corrections.near_pairs},
               {"partial_pairs", statistics.corrections.partial_pairs},
               {"clipped_pairs", statistics.corrections.clipped_pairs},
               {"rays", statistics.corrections.rays},
               {"bytes", statistics.correction_bytes}});
  return json;
}

Json solve_json(const RunRecord& record) {
  const Solution& solution = record.solution;
  const Radiosity& radiosity = *solution.radiosity;
  Json solve{{"solver", solver_text(radiosity.solver, record.places.size())},
             {"channels", radiosity.channels},
             {"iterations", radiosity.iterations},
             {"residual", number(radiosity.residual)},
             {"error_bound", number(radiosity.error_bound)},
             {"error_bound_rgb", triple(radiosity.largest_bound)},
             {"error_bound_rms_rgb", triple(radiosity.mean_square_bound)},
             {"converged", radiosity.converged},
             {"isa", solution.instruction_set}};
  if (solution.matrix) {
    solve["gathers"] = solution.matrix->gathered.gathers;
    solve["gathered_bytes_a_host"] = solution.matrix->gathered.bytes;
    solve["gather_wait_s"] = solution.matrix->gathered.wait_seconds;
    if (record.options.device != Device::cpu) solve["gpu_ranks"] = solution.matrix->form_factors->gpu_ranks;
  }
  if (!solution.solver_reason.empty()) solve["why"] = solution.solver_reason;
  if (radiosity.discretisation) {
    solve["variation_rgb"] = triple(*radiosity.discretisation);
  } else {
    solve["tolerance"] = radiosity.tolerance;
  }
  if (solution.heat_steps)
    solve["convection"] = {{"steps", solution.heat_steps->steps},
                           {"last_change_k", number(solution.heat_steps->change)},
                           {"error_bound", number(solution.heat_steps->error)},
                           {"tolerance", kHeatTolerance}};
  if (!radiosity.converged) solve["cause"] = radiosity.cause;
  return solve;
}

Json hierarchy_json(const HierarchyStatistics& statistics) {
  const auto known = [](const std::optional<double>& value) {
    return value ? number(*value) : Json(nullptr);
  };
  Json rounds = Json::array();
  for (const HierarchyRound& round : statistics.rounds)
    rounds.push_back({{"block_error", round.block_error},
                      {"links", round.links},
                      {"rows", round.rows},
                      {"nodes", round.nodes},
                      {"leaves", round.leaves},
                      {"iterations", round.iterations},
                      {"change", known(round.change)},
                      {"discretisation", known(round.discretisation)},
                      {"refine_s", round.refine_seconds},
                      {"solve_s", round.solve_seconds}});
  const HierarchyRound& last = statistics.rounds.back();
  const auto leaves = static_cast<double>(last.leaves);
  return {
      {"exchange", statistics.by_rays ? "rays" : "links"},
      {"rounds", rounds},
      {"rounds_resumed", statistics.rounds_resumed},
      {"errors",
       {{"discretisation", known(statistics.errors.discretisation)},
        {"rays", known(statistics.errors.rays)},
        {"picture", known(statistics.errors.picture)},
        {"iteration", number(statistics.errors.iteration)}}},
      {"chosen",
       {{"block_error", last.block_error},
        {"ray_error", statistics.gather_rays > 0 ? Json(statistics.ray_error) : Json(nullptr)},
        {"tolerance", statistics.tolerance}}},
      {"reached", statistics.reached ? Json(*statistics.reached) : Json(nullptr)},
      {"ended_by", statistics.ended_by ? Json(name_of(kRunLimitNames, *statistics.ended_by)) : Json(nullptr)},
      {"fits_memory", statistics.ended_by != RunLimit::memory},
      {"bytes_max", statistics.bytes},
      {"leaf_pairs", leaves * (leaves - 1) / 2},
      {"node_pairs_looked_at", statistics.pairs},
      {"shafts", statistics.shafts},
      {"contours", statistics.contours},
      {"rays", statistics.rays},
      {"gather_rays", statistics.gather_rays}};
}

Json mesh_json(const BakedMesh& baked) {
  return {{"faces", baked.mesh.elements.size()},
          {"vertices", baked.vertices.size()},
          {"noise", number(baked.noise)}};
}

Json light_map_json(const LightMap& map) {
  return {{"width", map.layout.width},          {"height", map.layout.height}, {"texel_m", map.layout.texel},
          {"charts", map.layout.charts.size()}, {"points", map.points},        {"noise", number(map.noise)}};
}

Json picture_json(const PictureStatistics& picture) {
  return {{"records", picture.records},
          {"single_pixels", picture.single},
          {"ray_error", picture.ray_error},
          {"error", picture.error ? number(*picture.error) : Json(nullptr)}};
}

Json forecast_json(const HierarchyForecast& forecast) {
  return {{"rounds", forecast.rounds},         {"links", forecast.last.links},
          {"bytes_max", forecast.last.bytes},  {"rounds_s", forecast.last.seconds},
          {"audit_s", forecast.audit_seconds}, {"picture_s", forecast.picture_seconds}};
}

/// What leaves all elements, the sum of A B.
Json leaving_json(const Solution& solution) {
  const std::span<const Element> elements = solution.subdivided.mesh.elements;
  Rgb sum(0);
  for (std::size_t i = 0; i < solution.radiosity->B.size(); ++i)
    sum += static_cast<double>(elements[i % elements.size()].area) * solution.radiosity->B[i];
  return triple(sum);
}

Json energy_json(const EnergyBalance& energy, bool thermal) {
  Json json{{"emitted", triple(energy.emitted)},
            {"absorbed", triple(energy.absorbed)},
            {"escaped", triple(energy.escaped)},
            {"dark", triple(energy.dark)},
            {"defect", triple(energy.defect)},
            {"defect_relative", number(largest_relative_defect(energy))},
            {"sampling_error", triple(energy.sampling_error)}};
  if (thermal) json["convected"] = triple(energy.convected);
  return json;
}

Json audited_json(const Audit& audit, const AuditedMean& mean) {
  return {{"name", mean.name},
          {"share", mean.share},
          {"mean", number(mean.mean)},
          {"bias", number(mean.bias)},
          {"half_interval", number(audit.width * mean.error)}};
}

Json audited_json(const AuditedRms& rms) {
  return {{"value", number(rms.value)}, {"low", number(rms.low)}, {"high", number(rms.high)}};
}

Json audit_json(const Audit& audit) {
  Json whole = Json::array(), parts = Json::array();
  for (const AuditedMean& mean : audit.whole) whole.push_back(audited_json(audit, mean));
  for (const AuditedMean& mean : audit.parts) parts.push_back(audited_json(audit, mean));
  return {{"places", audit.places},
          {"paths", audit.paths},
          {"rays", audit.rays},
          {"seconds", audit.seconds},
          {"error", audited_json(audit.of_places)},
          {"bias", whole},
          {"bias_of_parts", audit.parts.empty() ? Json(nullptr) : audited_json(audit.of_parts)},
          {"worst", audited_json(audit, audit.worst())},
          {"parts", parts},
          {"scale_of_reflected", triple(audit.scale)},
          {"verdict", audit.verdict ? Json(name_of(kAuditVerdictNames, *audit.verdict)) : Json(nullptr)}};
}

Json estimate_json(const Solution& solution) {
  const ErrorEstimate& estimate = *solution.error_estimate;
  Json json{{"convergence_rgb", triple(solution.radiosity->mean_square_bound)},
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

Json thermal_json(const std::vector<ThermalRow>& rows, TemperatureUnit unit) {
  const std::string temperature = unit == TemperatureUnit::celsius ? "temperature_c" : "temperature_k";
  Json json = Json::array();
  for (const ThermalRow& row : rows)
    json.push_back({{"group", row.group},
                    {"side", row.back ? "back" : "front"},
                    {"area_m2", row.area},
                    {temperature, number(in_unit(row.temperature, unit))},
                    {"emissivity", row.emissivity},
                    {"emitted_w", number(row.emitted)},
                    {"absorbed_w", number(row.absorbed)},
                    {"net_w", number(row.net)},
                    {"error_w", number(row.error)},
                    {"convected_w", number(row.convected)}});
  return json;
}

Json receivers_json(const RunRecord& record) {
  Json json = Json::object();
  for (const auto& [receiver, light, figures, unreached] : stated_receivers(record)) {
    json[receiver.name] = {{"quantity", name_of(kQuantityNames, receiver.quantity)},
                           {"unit", unit_of(receiver, record.scene.units)},
                           {"cells", light.measured.sensors.size()},
                           {"rays", light.measured.rays},
                           {"mean_rgb", triple(light.measured.mean)},
                           {"standard_error_rgb", triple(light.measured.relative_error)},
                           {"reached", light.measured.reached},
                           {"seconds", light.seconds}};
    json[receiver.name].update(figures_json(figures));
  }
  return json;
}

Json visibility_json(const MatrixStatistics& matrix) {
  Json json{{"pairs", matrix.forecast.pairs}};
  if (!matrix.visibility) return json;
  const VisibilityCounts& counts = *matrix.visibility;
  json.update({{"rays", counts.rays},
               {"bytes", counts.store_bytes},
               {"message_bytes", counts.message_bytes},
               {"tiles_uniform", counts.tiles_uniform},
               {"tiles_mixed", counts.tiles_mixed},
               {"tiles_resumed", counts.tiles_resumed},
               {"tiles_computed", counts.tiles_uniform + counts.tiles_mixed - counts.tiles_resumed}});
  if ((matrix.visibility_makers & kMadeByGpu) != 0)
    json["gpu"] = {{"names", matrix.gpus},
                   {"ranks", matrix.gpu_ranks},
                   {"tiles", counts.device.tiles},
                   {"verified_pairs", counts.device.verified_pairs},
                   {"differing_bits", counts.device.differing_bits},
                   {"processor_too", (matrix.visibility_makers & kMadeByProcessor) != 0}};
  return json;
}

/// What only a run over all pairs has.
void add_matrix(const Solution& solution, Json& json) {
  const MatrixStatistics& matrix = *solution.matrix;
  json["visibility"] = visibility_json(matrix);
  json["forecast"] = {{"visibility_s", matrix.forecast.visibility_seconds},
                      {"tiles_mixed_fraction", matrix.forecast.mixed_tiles},
                      {"visibility_bytes", matrix.forecast.store_bytes}};
  json["memory"]["predicted_bytes_max"] = matrix.forecast.bytes;
  if (solution.radiosity) json["memory"]["pss_bytes_sum"] = solution.held_bytes;
  if (matrix.visibility) json["hash"]["visibility"] = hash_text(matrix.visibility_hash);
}

/// What any method's solution has.
void add_solution(const RunRecord& record, Json& json) {
  const Solution& solution = record.solution;
  if (solution.form_factor_sums) json["form_factor"] = form_factor_json(solution);
  if (solution.energy) json["energy"] = energy_json(*solution.energy, record.options.thermal);
  json["leaving"] = leaving_json(solution);
  // A view shows what an earlier run has solved.
  if (record.options.method != Method::view) json["solve"] = solve_json(record);
  if (record.options.thermal) json["thermal"] = thermal_json(solution.thermal, record.scene.temperature_unit);
}

}  // namespace

std::string solver_text(Solver solver, std::size_t ranks) {
  const bool in_blocks = solver == Solver::gauss_seidel && ranks > 1;
  return in_blocks ? "block gauss-seidel, jacobi coupling between ranks" : name_of(kSolverNames, solver);
}

Json report_json(const OutputSource& source) {
  const RunRecord& record = source.record;
  const Solution& solution = record.solution;
  const std::span<const Element> elements = solution.subdivided.mesh.elements;
  Json json{{"patches", record.scene.patches.size()},
            {"elements", elements.size()},
            {"unknowns", count_unknowns(elements).active},
            {"ranks", record.places.size()},
            {"threads", record.places.front().threads},
            {"options", options_json(record.options)},
            {"version", version_text()},
            {"time_s", time_json(record.time, &PhaseTime::wall)},
            {"cpu_s", time_json(record.time, &PhaseTime::processor)},
            {"scene", scene_json(record)}};
  if (record.options.subdivision != Subdivision::transport)
    json["subdivision"] = {{"deepest_tree", solution.subdivided.max_depth},
                           {"max_edge_m", number(solution.subdivided.max_edge)}};
  json["memory"] = {{"peak_rss_bytes_max", record.peak_bytes}};
  json["hash"] = {{"elements", hash_text(solution.subdivided.hash)}};
  if (solution.matrix) add_matrix(solution, json);
  if (solution.radiosity) add_solution(record, json);
  if (solution.hierarchy) json["hierarchy"] = hierarchy_json(*solution.hierarchy);
  if (solution.hierarchy && solution.hierarchy->forecast)
    json["forecast"] = forecast_json(*solution.hierarchy->forecast);
  if (solution.stated_error) json["stated_error"] = number(*solution.stated_error);
  if (solution.audit) json["audit"] = audit_json(*solution.audit);
  if (solution.error_estimate) json["error_estimate"] = estimate_json(solution);
  if (!solution.sensors.empty()) json["receivers"] = receivers_json(record);
  if (!solution.glare.empty()) json["observers"] = observers_json(observer_ratings(record));
  if (solution.end == RunEnd::solution && !record.scene.tasks.empty())
    json["tasks"] = tasks_json(task_verdicts(record));
  if (solution.checkpoint)
    json["checkpoint"] = {{"files", solution.checkpoint->files},
                          {"bytes", solution.checkpoint->bytes},
                          {"writes", solution.checkpoint->writes},
                          {"seconds", solution.checkpoint->seconds}};
  if (solution.mesh) json["mesh"] = mesh_json(*solution.mesh);
  if (solution.light_map) json["light_map"] = light_map_json(*solution.light_map);
  if (solution.picture) json["picture"] = picture_json(*solution.picture);
  if (solution.ray_devices) json["gpu"] = gpu_json(*solution.ray_devices, "rays");
  if (source.exposure) json["image"] = {{"exposure_stops", *source.exposure}};
  if (source.noise) json["image"]["seen_noise"] = number(*source.noise);
  if (const Json progress = progress_json(record.phases); !progress.empty()) json["progress"] = progress;
  json["ranks_detail"] = ranks_json(record);
  json["notes"] = record.scene.notes;
  json["warnings"] = record.warnings;
  return without_unknown(json);
}

void write_report(const std::filesystem::path& file, const OutputSource& source) {
  write_bytes_atomically(file, json_text(report_json(source)));
}

}  // namespace fluxel
