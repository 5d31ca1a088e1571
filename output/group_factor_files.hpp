#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formfactor/view_factor_table.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// The names by which --write asks for the table of groups or their matrix.
inline constexpr std::string_view kTableAsked = "csv", kMatrixAsked = "npz";

/// With more groups the matrix is written where neither is asked for: of so many that all see each other the
/// table has 15 MB.
inline constexpr std::size_t kMostGroupsInTable = 500;

/// Files of view factors between groups that some run may write.
inline constexpr std::array kGroupFactorFiles{"view-factors.csv", "view-factors.npz", "surfaces.csv"};

/// Writes view-factors.csv or view-factors.npz and surfaces.csv, or all, as is asked for, and removes those
/// of an earlier run that are not. Returns the names of what was written. Throws InputError where it cannot.
[[nodiscard]] std::vector<std::string> write_group_factors(const std::filesystem::path& folder,
                                                           const Scene& scene, const ExchangeTable& groups,
                                                           std::span<const std::string> asked);

}  // namespace fluxel
