#pragma once

#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "method/solution.hpp"
#include "metrics/phase_record.hpp"

namespace fluxel {

// What the JSON files have in common.

using Json = nlohmann::ordered_json;

/// JSON has no infinity; null says that there is no number, and without_unknown leaves it out.
[[nodiscard]] Json number(double value);
[[nodiscard]] Json triple(const glm::dvec3& value);

/// Without members that are unknown: null, a number that is not finite, or an array that has any of these.
[[nodiscard]] Json without_unknown(const Json& json);

/// GPUs that have traced what `made` names, as rays.
[[nodiscard]] Json gpu_json(const RayDeviceStatistics& gpus, const std::string& made);

/// As a file. Of names that are not UTF-8 the wrong bytes are replaced.
[[nodiscard]] std::string json_text(const Json& json);

enum class Phases { ended, all };

/// What long phases forecast of their end while they ran; of one that still runs `final_s` is when it was
/// looked at last, and `forecast_s`, once known, when it will end.
[[nodiscard]] Json progress_json(const std::vector<PhaseRecord>& phases, Phases which = Phases::ended);

}  // namespace fluxel
