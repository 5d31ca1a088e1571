#pragma once

#include <span>

#include "formfactor/corrections.hpp"
#include "formfactor/near_pair.hpp"
#include "visibility/tile_store.hpp"

namespace fluxel {

struct FoundCorrections {
  Corrections corrections;
  CorrectionCounts counts;  ///< of pairs that meet the owned rows
};

/// The corrections of the rows whose tiles `store` owns. With FormFactor::adaptive these are the pairs whose
/// moments_error exceeds kPairTolerance times the tolerance or which cross each other's plane, and, with
/// partial visibility, those at the edges of shadows (among bits that differ, and wherever the share of the
/// power is large) of which rays say other than the bit; with FormFactor::points all pairs; with point and
/// disc none. Same values for every split of the rows and every number of threads. Throws std::length_error
/// for more unknowns than 32 bits count.
[[nodiscard]] FoundCorrections find_corrections(const RayScene& ray_scene, const Scene& scene,
                                                const ElementView& mesh, const TileStore& store,
                                                const FormFactorOptions& options, const PowerEstimate& power,
                                                int threads);

}  // namespace fluxel
