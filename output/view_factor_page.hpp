#pragma once

#include <filesystem>

#include "formfactor/view_factor_table.hpp"
#include "scene/scene.hpp"

namespace fluxel {

struct ViewFactorOptions;

inline constexpr const char* kViewFactorPage = "view-factors.html";

/// Writes the view factors of groups as a page: a map of those of the largest sides, and what can be checked.
/// Throws InputError where it cannot.
void write_view_factor_page(const std::filesystem::path& file, const ViewFactorOptions& options,
                            const Scene& scene, const ExchangeTable& table, const ViewFactorChecks& checks,
                            int ranks);

}  // namespace fluxel
