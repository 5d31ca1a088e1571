#include "output/json_parts.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace fluxel {

namespace {

bool is_known(const Json& json) {
  if (json.is_array()) return std::ranges::all_of(json, is_known);
  return !json.is_null() && (!json.is_number_float() || std::isfinite(json.get<double>()));
}

}  // namespace

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json triple(const glm::dvec3& value) {
  return Json::array({number(value.r), number(value.g), number(value.b)});
}

Json without_unknown(const Json& json) {
  if (!json.is_structured()) return json;
  Json known = json.is_object() ? Json::object() : Json::array();
  if (json.is_array())
    for (const Json& value : json) known.push_back(without_unknown(value));
  else
    for (const auto& [key, value] : json.items())
      if (is_known(value)) known[key] = without_unknown(value);
  return known;
}

Json gpu_json(const RayDeviceStatistics& gpus, const std::string& made) {
  return {{"names", gpus.names},
          {"ranks", gpus.ranks},
          {made, gpus.counts.made},
          {"verified_" + made, gpus.counts.verified},
          {"differing_" + made, gpus.counts.differing}};
}

std::string json_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json progress_json(const std::vector<PhaseRecord>& phases, Phases which) {
  Json json = Json::object();
  for (const PhaseRecord& phase : phases) {
    if (phase.samples().empty() || (which == Phases::ended && !phase.finished())) continue;
    Json samples = Json::array();
    for (const PhaseSample& sample : phase.samples()) {
      Json row{{"time_s", sample.seconds}, {"done", sample.done}, {"forecast_s", number(sample.forecast)}};
      if (phase.has_errors()) {
        row["error"] = number(sample.error);
        row["target"] = sample.target;
      }
      samples.push_back(row);
    }
    const PhaseSample& last = phase.samples().back();
    Json of_phase{{"final_s", last.seconds}};
    if (!phase.finished()) of_phase.update({{"under_way", true}, {"forecast_s", number(last.forecast)}});
    if (phase.has_errors()) of_phase["target"] = last.target;
    of_phase["samples"] = samples;
    std::string key = phase.name();
    std::erase(key, '\'');  // of "observers' eyes"
    std::ranges::replace(key, ' ', '_');
    json[key] = of_phase;
  }
  return without_unknown(json);
}

}  // namespace fluxel
