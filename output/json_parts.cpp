#include "output/json_parts.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace fluxel {

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json triple(const glm::dvec3& value) {
  return Json::array({number(value.r), number(value.g), number(value.b)});
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
      Json row{sample.seconds, sample.done, number(sample.forecast)};
      if (phase.has_errors()) {
        row.push_back(number(sample.error));
        row.push_back(sample.target);
      }
      samples.push_back(row);
    }
    const PhaseSample& last = phase.samples().back();
    Json of_phase{{"final_s", last.seconds}};
    if (!phase.finished()) of_phase["forecast_s"] = number(last.forecast);
    if (phase.has_errors()) of_phase["target"] = last.target;
    of_phase["samples"] = samples;
    std::string key = phase.name();
    std::ranges::replace(key, ' ', '_');
    json[key] = of_phase;
  }
  return json;
}

}  // namespace fluxel
