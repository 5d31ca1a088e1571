#pragma once

#include <vector>

#include "core/progress.hpp"
#include "formfactor/surface_exchange.hpp"
#include "mpi_master/communication/communicator.hpp"

namespace fluxel {

/// Collective: the exchange of all pairs of surfaces on the root, nothing on the others; the same for every
/// number of ranks and threads. Ranks take every size()-th row of clusters, which levels their different
/// lengths.
[[nodiscard]] SurfaceExchanges exchange_of_surfaces(const Communicator& communicator, const FacePairs& pairs,
                                                    int threads, Progress& progress);

}  // namespace fluxel
