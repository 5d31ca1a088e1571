#pragma once

#include "output/json_parts.hpp"
#include "output/measured_files.hpp"
#include "output/reference_files.hpp"

namespace fluxel {

/// Writes what has been measured as a page, STEM.html: `report` is what STEM.json says; the elements are
/// those that were measured, if any were. Throws InputError where it cannot.
void write_measured_page(const MeasuredRun& run, const Scene& scene, const FileElements& elements,
                         const Solution& solution, const MeasuredCost& cost, const Json& report);

}  // namespace fluxel
