#pragma once

#include <filesystem>
#include <span>

#include "formfactor/view_factor_table.hpp"
#include "scene/scene.hpp"

namespace fluxel {

inline constexpr const char* kViewFactorFile = "view-factors.csv";

/// Writes a row `from,from_side,to,to_side,area_from_m2,view_factor,error_estimate` for every factor as CSV;
/// `areas` [m2] has an entry a surface. Throws InputError where it cannot be written.
void write_view_factors(const std::filesystem::path& file, const Scene& scene,
                        std::span<const SurfaceViewFactor> factors, std::span<const double> areas);

}  // namespace fluxel
