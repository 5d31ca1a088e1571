#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "hierarchy/irradiance_source.hpp"
#include "method/problem.hpp"

namespace fluxel {

/// Light of points that the root alone lists, with entries on the root.
struct RootGather {
  /// Irradiance [W/m2] by two halves of the rays, of which the mean is meant.
  std::array<std::vector<Rgb>, 2> halves;
  double noise = 0;  ///< of what the points reflect, root mean square over the mean, as some of them tell
  Rgb mean{0};       ///< what they reflect [W/m2], likewise
};

/// The mean of halves, no less than 0, which linear functions of leaves may be below [W/m2].
[[nodiscard]] std::vector<Rgb> light_of(const std::array<std::vector<Rgb>, 2>& halves);

/// How much noise the light of points may have that a run was given this target error for (0: none): a part
/// of it, and no more than what is hardly seen on smooth walls.
[[nodiscard]] double allowed_noise(double target);

/// Collective: gathers at many points with rays that bring the noise to `allowed`, root mean square over the
/// mean. `what` names the phase; `seed` tells the rays from those of other lists. Throws
/// StopRequest, between parts of some seconds, where a signal has asked for it.
[[nodiscard]] RootGather gather_on_root(const Problem& problem, IrradianceSource& source,
                                        std::span<const GatherPoint> points, double allowed,
                                        std::uint64_t seed, const std::string& what);

/// The standard error of each point's mean of halves [W/m2]. Its own halves hardly tell: it is taken from up
/// to 16 more points of the same face that stand around it in the list.
[[nodiscard]] std::vector<Rgb> noise_of_points(std::span<const GatherPoint> points,
                                               const std::array<std::vector<Rgb>, 2>& halves);

}  // namespace fluxel
