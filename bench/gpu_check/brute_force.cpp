#include "bench/gpu_check/brute_force.hpp"

#include "visibility/cuda/trace_group.hpp"

namespace fluxel::cuda::checks {

bool sees_by_brute_force(const TileScene& scene, const End& row, const End& column) {
  const auto is_open = [&](const Double3& from, const Double3& to) {
    for (std::uint32_t patch = 0; patch < scene.patches; ++patch) {
      if (segment_meets(polygon_of(scene.exact[patch]), from, to)) return false;
    }
    return true;
  };
  for (std::uint32_t row_side = 0; row_side < 2; ++row_side) {
    for (std::uint32_t column_side = 0; column_side < 2; ++column_side) {
      if (!face_each_other(row, column, {row_side, column_side}, 2 * scene.lift)) continue;
      const Float3 from = lifted(row, row_side, scene.lift);
      const Float3 along = lifted(column, column_side, scene.lift) - from;
      if (is_open(widen(from), widen(from) + widen(along))) return true;
    }
  }
  return false;
}

}  // namespace fluxel::cuda::checks
