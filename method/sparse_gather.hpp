#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/rgb.hpp"
#include "hierarchy/irradiance_source.hpp"
#include "method/problem.hpp"

namespace fluxel {

/// What is asked of reflected light that is gathered at few of a picture's pixels.
struct SparseGoal {
  double ray_error = 0;  ///< see GatherGoal, of a record
  double allowed = 0;    ///< error of the picture, root mean square over the mean
  Rgb mean{0};           ///< that mean: radiosity of what is seen [W/m2]
  std::uint64_t seed = 0;
};

struct SparseLight {
  std::vector<Rgb> irradiance;  ///< of each pixel [W/m2]
  std::size_t records = 0;
  std::size_t single = 0;  ///< pixels that were gathered each on its own
  double error = 0;        ///< as SparseGoal::allowed, by what the records say of each other
};

/// Collective: the irradiance of pixels by reflected light, interpolated between records at some of them, of
/// which there are more until those around every pixel let expect a small error. `points` are those of the
/// pixels, of whole rows of `width`.
[[nodiscard]] SparseLight gather_sparsely(const Problem& problem, IrradianceSource& source, int width,
                                          std::span<const GatherPoint> points, const SparseGoal& goal);

}  // namespace fluxel
