#pragma once

#include <optional>

#include "method/problem.hpp"
#include "mpi_master/steps/renewal_job.hpp"
#include "photons/photon_scene.hpp"
#include "photons/tally_file.hpp"

namespace fluxel {

/// A tally after a change of the scene.
struct RenewedPhotons {
  PhotonTally tally;
  RenewalResult result;
};

/// Collective: the kept tally of PhotonRequest::before, renewed for the problem's scene. `key` is the
/// problem's; `show` is as renew_photons has it. Throws AgreedError where the scenes are not such that
/// photons could be renewed, or there is no tally of the scene before.
[[nodiscard]] RenewedPhotons renew_kept_photons(const Problem& problem, const PhotonScene& after,
                                                const ElementView& mesh, std::span<const Receiver> receivers,
                                                const TallyKey& key,
                                                const std::function<void(const PhotonTally&)>& show);

}  // namespace fluxel
