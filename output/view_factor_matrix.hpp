#pragma once

#include <filesystem>

#include "formfactor/view_factor_table.hpp"
#include "scene/scene.hpp"

namespace fluxel {

inline constexpr const char* kViewFactorMatrix = "view-factors.npz";
inline constexpr const char* kSurfaceFile = "surfaces.csv";

/// Writes the view factors between groups as a sparse matrix by rows, the archive of NumPy arrays that
/// scipy.sparse.load_npz reads: format ("csr"), shape (2), data (float64), indices, indptr (int32, or int64
/// from 2^31 factors on), and besides error_estimate (float32), like data, and area_m2 (float64) of the rows.
/// Rows are the surfaces that have an area, from 0. Throws InputError where it cannot be written.
void write_view_factor_matrix(const std::filesystem::path& file, const ExchangeTable& table);

/// Writes `row,group,side,area_m2`: what the matrix's rows are. Throws as above.
void write_surfaces(const std::filesystem::path& file, const Scene& scene, std::span<const double> areas);

}  // namespace fluxel
