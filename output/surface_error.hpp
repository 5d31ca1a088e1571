#pragma once

#include <optional>

#include "output/run_record.hpp"

namespace fluxel {

/// What a run states of its surfaces, as radiosity [W/m2]: the stated error times the mean of all of them. It
/// is a root mean square, the same for all places. None where a run states nothing, or of its picture.
[[nodiscard]] std::optional<Rgb> surface_error(const RunRecord& record);

/// With the noise of one place, by rays.
[[nodiscard]] Rgb error_with_noise(const Rgb& surface_error, const Rgb& noise);

}  // namespace fluxel
