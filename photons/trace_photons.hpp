#pragma once

#include <cstdint>

#include "core/choices.hpp"
#include "photons/photon_scene.hpp"
#include "photons/photon_tally.hpp"

namespace fluxel {

/// The points that photons of a run go by.
struct PhotonPoints {
  Sequence sequence = Sequence::sobol;
  std::uint64_t seed = 1;  ///< of those that have one
};

/// How many parts such photons belong to.
[[nodiscard]] std::size_t parts_of(Sequence sequence);

/// Photons of these indices.
struct PhotonRange {
  std::uint64_t first = 0, last = 0;  ///< up to, not with, last
};

/// Follows the photons, by the threads of the caller's task arena, and adds what they bring to the tally,
/// which is the same for any of them and in any order.
void trace_photons(const PhotonScene& scene, const PhotonPoints& points, const PhotonRange& range,
                   PhotonTally& tally);

}  // namespace fluxel
