#pragma once

#include <filesystem>

#include "formfactor/view_factor_table.hpp"
#include "scene/scene.hpp"

namespace fluxel {

inline constexpr const char* kViewFactorFile = "view-factors.csv";

/// Writes a row `from,from_side,to,to_side,area_from_m2,view_factor,error_estimate` for every factor between
/// groups as CSV. Throws InputError where it cannot be written.
void write_view_factors(const std::filesystem::path& file, const Scene& scene, const ExchangeTable& table);

}  // namespace fluxel
