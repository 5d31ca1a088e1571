#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "output/output_table.hpp"

namespace fluxel {

/// Linear radiance [W/m2/sr] of each texel of a run's light map; layers `irradiance` and `irradiance_noise`
/// [W/m2], `noise` and, of runs that state an error of their surfaces, `error` of the radiance.
void write_light_map_exr(const std::filesystem::path& file, const OutputSource& source,
                         const std::map<std::string, std::string>& attributes);

/// The bytes of a PNG, shown as the run's picture is.
[[nodiscard]] std::string light_map_png(const OutputSource& source);

/// The surfaces with places in the light map (TEXCOORD_1), which is inside as that PNG.
void write_light_map_glb(const std::filesystem::path& file, const OutputSource& source);

}  // namespace fluxel
