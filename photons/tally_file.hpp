#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/element.hpp"
#include "photons/photon_tally.hpp"
#include "photons/trace_photons.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// A hash of all that photons meet: what the visibility of the scene does (see visibility_identity),
/// materials, luminaires, elements, receivers, and the way this program follows photons. Threads and ranks
/// change nothing in it.
[[nodiscard]] std::uint64_t photon_identity(const RayScene& ray_scene, const ElementView& mesh,
                                            std::span<const Receiver> receivers);

/// What a file of a tally belongs to.
struct TallyKey {
  std::uint64_t identity = 0;
  PhotonPoints points;
};

/// The bytes of such a file; docs/file-formats.md has the format. The photons are those from 0 on.
[[nodiscard]] std::string tally_file(const TallyKey& key, const PhotonTally& tally);

/// What reading such a file came to.
struct TallyFileResult {
  std::optional<PhotonTally> tally;
  std::string defect;  ///< why there is none, as the end of a sentence
};

/// Reads the bytes of such a file, wherever they come from, of a tally of this shape.
[[nodiscard]] TallyFileResult read_tally_file(std::span<const std::byte> bytes, const TallyKey& key,
                                              const TallyShape& shape);

}  // namespace fluxel
