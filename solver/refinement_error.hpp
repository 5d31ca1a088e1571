#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/rgb.hpp"

namespace fluxel {

/// The radiosity of one mesh, an entry an unknown: fronts of all elements, then, where they are two-sided,
/// backs. Area is 0 where a side is no unknown.
struct MeshRadiosity {
  std::vector<double> area;  ///< [m2]
  std::vector<Rgb> B;        ///< [W/m2]
};

/// The same of a mesh of unions of elements.
struct CoarserRadiosity {
  MeshRadiosity radiosity;
  std::vector<std::uint32_t> first;  ///< finer element of each, and the number of finer elements at the end
};

/// Area-weighted means over the coarser elements that `first` describes.
[[nodiscard]] MeshRadiosity averaged(const MeshRadiosity& fine, std::span<const std::uint32_t> first);

/// What is taken for the order where there are two meshes only.
inline constexpr double kUnseenOrder = 1;
/// Orders that meshes can show: shadow edges and constant elements on smooth radiosity.
inline constexpr double kLowestOrder = 0.5, kHighestOrder = 2;

/// The error of the finest of several meshes, from their differences.
struct RefinementError {
  Rgb error{0};  ///< area-weighted root mean square error of B of the elements, over the area-mean of B
  std::optional<double>
      order;             ///< differences fall by 2^order when edges become half as long; as it was seen
  double survival = 1;   ///< of a difference that is averaged over the next coarser elements, relative
  double alignment = 1;  ///< correlation of that with the next coarser difference
};

/// With R the average over coarser elements, meshes 0 (the finest), 1, 2 have the differences D1 = R B0 - B1
/// and D2 = R B1 - B2. The mean of the true radiosity over the elements of mesh 0 is B0 + D0 + R D-1 + R R
/// D-2 + ... over all meshes that could follow. They are taken to go on as the known ones do: each difference
/// g = |D2| / |D1| times smaller than the coarser one before it (within 2^kLowestOrder and 2^kHighestOrder);
/// each average shrinks it to s = |R D1| / |D1|; terms that follow one another have the correlation c of R D1
/// and D2, those k apart c^k. Then, with q = s / g,
///   |error| = |D1| / g sqrt((1 + c q) / ((1 - c q) (1 - q q))).
/// Smooth errors have s = c = 1, which is Richardson's extrapolation |D1| / (g - 1) (Richardson 1911); noise
/// that is independent from element to element has s = 1/2 where four elements become one, c = 0.
/// `coarser` has one mesh or two, the finer first; colours share g, s and c.
/// `iteration`: what is left of the iteration's error in B0, root mean square over the mean. An iteration
/// that has started from B1 falls short towards it, so that D1 may lack as much.
[[nodiscard]] RefinementError refinement_error(const MeshRadiosity& fine,
                                               std::span<const CoarserRadiosity> coarser,
                                               const Rgb& iteration = Rgb(0));

}  // namespace fluxel
