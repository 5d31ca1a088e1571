#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/options.hpp"
#include "mpi_master/communication/workers.hpp"
#include "mpi_master/steps/photon_ending.hpp"
#include "photons/photon_estimates.hpp"
#include "photons/photon_scene.hpp"
#include "photons/photon_tally.hpp"
#include "photons/trace_photons.hpp"

namespace fluxel {

/// Which photons are sent, and when they are enough.
struct PhotonGoal {
  PhotonPoints points;
  PhotonLimits limits;
};

/// Slots whose error is looked at together: elements, or a receiver.
struct PhotonKind {
  std::string name;          ///< elements, or the receiver's
  std::size_t received = 0;  ///< see PhotonTally::add_received
  SlotRange slots;
  bool decides = true;  ///< on the end
};

/// How matters stood after a turn.
struct PhotonTurn {
  std::uint64_t photons = 0;             ///< from the first on, with those of earlier jobs
  double seconds = 0;                    ///< of this job, by this rank's clock
  double processor_seconds = 0;          ///< of all ranks
  std::vector<IrradianceErrors> errors;  ///< of each kind
};

/// The same on all ranks.
struct PhotonResult {
  std::vector<PhotonTurn> turns;
  PhotonEnding ending = PhotonEnding::target;
  bool reached = true;         ///< the errors asked for, of all kinds whose errors they are
  std::uint64_t restored = 0;  ///< photons of earlier jobs
};

/// A kind's error over its mean, of the channel where it is largest; 0 where nothing has come.
[[nodiscard]] double relative_error(const IrradianceErrors& errors);
/// The error itself [W/m2] or [lx], likewise.
[[nodiscard]] double absolute_error(const IrradianceErrors& errors);

/// How many photons there are points for, and sums have room for, at most.
[[nodiscard]] std::uint64_t most_photons(Sequence sequence);

/// What must not be asked for: more photons than sums have room for. Empty: nothing.
[[nodiscard]] std::string refused_photons(const PhotonGoal& goal);

/// Collective: sends photons until a limit is come to, in turns of which each adds a quarter to an eighth of
/// what there is, up to 2^24. The ranks and their threads take a part of each turn; its sums are those of all
/// after it, whole numbers that are the same for any ranks and threads. `tally`: what earlier jobs have come
/// to, and then all. `keep` is called on the root within turns, with what there is, when `keep_every` seconds
/// have passed or SIGUSR1 asks for it. Throws AgreedError where memory does not suffice, or sums have no room
/// for more.
[[nodiscard]] PhotonResult send_photons(const Workers& workers, const PhotonScene& scene,
                                        std::span<const PhotonKind> kinds, const PhotonGoal& goal,
                                        PhotonTally& tally, double keep_every,
                                        const std::function<void(const PhotonTally&)>& keep);

}  // namespace fluxel
