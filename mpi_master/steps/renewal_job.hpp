#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "mpi_master/communication/workers.hpp"
#include "mpi_master/steps/photon_ending.hpp"
#include "photons/photon_renewal.hpp"

namespace fluxel {

/// Which photons go again, and for how long.
struct RenewalGoal {
  std::uint64_t photons = 0;               ///< of the tally, from index 0 on
  std::vector<std::uint64_t> partings{1};  ///< see coherent_groups; the last is that of the groups
  std::optional<double> seconds;
  std::optional<std::uint64_t> renewed;  ///< photons that have gone again
};

/// How matters stood after a turn.
struct RenewalTurn {
  std::uint64_t renewed = 0;  ///< photons that have gone again
  std::uint64_t changed = 0;  ///< of these, that have brought something else than before
  std::uint64_t groups = 0;   ///< that have been renewed as a whole
  double left = 0;            ///< photons expected to bring the light of the scene before
  double seconds = 0;         ///< by this rank's clock
};

/// The same on all ranks.
struct RenewalResult {
  std::uint64_t photons = 0, groups = 0;
  std::uint64_t pilots = 0;          ///< the first photons
  std::uint64_t changed_pilots = 0;  ///< of these
  std::vector<RenewalTurn> turns;
  PhotonEnding ending = PhotonEnding::renewed;

  [[nodiscard]] bool complete() const { return ending == PhotonEnding::renewed; }
};

/// Collective: lets photons go again, first pilots, the photons from index 0 on, and then group after group,
/// those first of which most are expected to bring something else than before (selective photon tracing:
/// Dmitriev et al. 2002), by what pilots and groups have told until then (expected_shares). `tally`:
/// PhotonRenewal::taken_over, and then what has been renewed. `show` is called on the root every few seconds,
/// and where SIGUSR1 asks for it.
[[nodiscard]] RenewalResult renew_photons(const Workers& workers, const PhotonRenewal& renewal,
                                          const RenewalGoal& goal, PhotonTally& tally,
                                          const std::function<void(const PhotonTally&)>& show);

}  // namespace fluxel
