#pragma once

#include <span>
#include <vector>

#include "core/sensor_estimate.hpp"
#include "photons/photon_tally.hpp"

namespace fluxel {

/// Slots in a row, and what they count for.
struct SlotRange {
  std::size_t first = 0;
  std::span<const double> areas;  ///< of each [m2]; 0: nothing is measured there
  bool has_squares = false;       ///< cells of receivers, where the tally has squares of them
};

/// The irradiance of slots [W/m2] or [lx], where `power` is that of all photons together [W] or [lm]. Errors
/// are known of randomisations, and where there are squares (Voloboy et al. 2009, equations 7 and 8); else
/// they are 0.
[[nodiscard]] std::vector<SensorEstimate> irradiance_estimates(const PhotonTally& tally,
                                                               const SlotRange& slots, double power);

/// Of all slots of a range together, means weighted by area.
struct IrradianceErrors {
  Rgb mean{0};
  Rgb quadratic_mean{0};  ///< root mean square, without what noise adds
  Rgb error{0};           ///< root mean square of the errors
};

/// By randomisations, by squares, or by the two halves: half of their root mean square difference (Dmitriev
/// 2002, equation 15, where each half has the power of the whole).
[[nodiscard]] IrradianceErrors irradiance_errors(const PhotonTally& tally, const SlotRange& slots,
                                                 double power);

/// Whether the errors of single slots are known.
[[nodiscard]] inline bool knows_each_error(const PhotonTally& tally, const SlotRange& slots) {
  return tally.shape().parts == static_cast<std::size_t>(kRandomisations) || slots.has_squares;
}

}  // namespace fluxel
