#pragma once

#include <span>

#include "hierarchy/irradiance_source.hpp"
#include "method/error_control.hpp"

namespace fluxel {

/// What is known of probes, and the rays that others like them get.
struct ProbedRays {
  ProbedLight light;
  double ray_error = 0;  ///< see GatherGoal
  double noise = 0;      ///< of these rays, root mean square over the mean; 0 where that is 0
};

/// Collective: gathers at the probes until it is known by which rays the noise of what they reflect, root
/// mean square over the mean, is at most `allowed`.
[[nodiscard]] ProbedRays probe_for(IrradianceSource& source, std::span<const GatherPoint> probes,
                                   double allowed);

}  // namespace fluxel
