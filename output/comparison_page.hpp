#pragma once

#include "image/tone_map.hpp"
#include "output/comparison_report.hpp"
#include "output/json_parts.hpp"

namespace fluxel {

/// Writes the comparison as a page, compare.html: `json` is what compare.json says. Throws InputError where
/// it cannot.
void write_comparison_page(const CompareOptions& options, const Comparands& of,
                           const ComparisonReport& report, const Json& json);

/// The map of errors of pixels: see diverging_colours.
[[nodiscard]] DisplayPicture error_map(const Comparands& of, const ComparisonReport& report);

/// Of each element the error of the side that is further off, of all colours together, over the mean.
[[nodiscard]] std::vector<double> errors_of_elements(const Comparands& of, const ComparisonReport& report);

}  // namespace fluxel
