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
  std::vector<Rgb> H, noise_of_H;  ///< irradiance and its standard error by rays [W/m2]
  double noise = 0;  ///< of what the points reflect, root mean square over the mean, as some of them tell
};

/// Collective: gathers at many points with rays that bring the noise to a part of `target`, an error that the
/// solution has been given (0: none), and below what is seen on smooth walls. Of a point's own noise two
/// halves of the rays hardly tell anything: it is taken from up to 16 points of the same face that stand
/// around it in the list. `what` names the phase; `seed` tells the rays from those of other lists.
[[nodiscard]] RootGather gather_on_root(const Problem& problem, IrradianceSource& source,
                                        std::span<const GatherPoint> points, double target,
                                        std::uint64_t seed, const std::string& what);

}  // namespace fluxel
