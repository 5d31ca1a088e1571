#include "mpi_master/steps/photon_job.hpp"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "core/signals.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/machine.hpp"
#include "mpi_master/steps/forecast.hpp"
#include "mpi_master/steps/photon_turns.hpp"
#include "solver/channels.hpp"

namespace fluxel {

namespace {

/// Of the points of a randomisation, whose index has 32 bits.
constexpr std::uint64_t kMostScrambled = std::uint64_t{kRandomisations} << 32;

/// A rank's part of a turn.
PhotonRange share_of(const PhotonRange& turn, const Communicator& communicator) {
  const auto rank = static_cast<std::uint64_t>(communicator.rank());
  const auto ranks = static_cast<std::uint64_t>(communicator.size());
  const std::uint64_t count = turn.last - turn.first;
  const auto place = [&](std::uint64_t k) {
    return turn.first + count / ranks * k + count % ranks * k / ranks;
  };
  return {place(rank), place(rank + 1)};
}

}  // namespace

double relative_error(const IrradianceErrors& errors) {
  double worst = 0;
  for (int c = 0; c < kChannels; ++c)
    if (errors.mean[c] > 0) worst = std::max(worst, errors.error[c] / errors.mean[c]);
  return worst;
}

double absolute_error(const IrradianceErrors& errors) { return largest_channel(errors.error); }

std::uint64_t most_photons(Sequence sequence) {
  return sequence == Sequence::scrambled ? kMostScrambled : PhotonTally::kMostPhotons;
}

std::string refused_photons(const PhotonGoal& goal) {
  const bool is_scrambled = goal.points.sequence == Sequence::scrambled;
  const std::uint64_t most = most_photons(goal.points.sequence);
  if (!goal.limits.photons || *goal.limits.photons <= most) return {};
  return fmt::format("--photons {}: {} {} is the most that {}", *goal.limits.photons,
                     is_scrambled ? "of --sequence scrambled" : "in all", most,
                     is_scrambled ? "its points have" : "sums of 62 bits have room for");
}

PhotonResult send_photons(const Workers& workers, const PhotonScene& scene, std::span<const PhotonKind> kinds,
                          const PhotonGoal& goal, PhotonTally& tally, double keep_every,
                          const std::function<void(const PhotonTally&)>& keep) {
  const Communicator& communicator = workers.communicator;
  require_memory(communicator, 8 * PhotonTally::size_of(tally.shape()), "the photons' sums",
                 "use larger elements, fewer ranks on a host, or --only receivers");
  PhotonResult result;
  result.restored = tally.count(PhotonCount::sent);
  PhotonTurns turns(communicator, goal, kinds, result.restored);
  PhotonTally own(tally.shape());
  tbb::task_arena arena(workers.threads);
  const double processor_start = all_processor_seconds(communicator);
  double kept = turns.seconds();
  const auto look = [&] {
    PhotonTurn turn{tally.count(PhotonCount::sent),
                    turns.seconds(),
                    all_processor_seconds(communicator) - processor_start,
                    {}};
    for (const PhotonKind& kind : kinds)
      turn.errors.push_back(irradiance_errors(tally, kind.slots, scene.sources().power()));
    turns.look(turn, tally);
    result.turns.push_back(std::move(turn));
    turns.report(tally.count(PhotonCount::sent), false, workers.progress);
  };
  /// Up to so many; false where time or a signal has ended it.
  const auto send_until = [&](std::uint64_t next) {
    while (tally.count(PhotonCount::sent) < next) {
      const std::uint64_t sent = tally.count(PhotonCount::sent);
      const std::uint64_t until = turns.next_part(sent, next);
      if (until == sent) {
        result.ending = PhotonEnding::time;
        return false;
      }
      arena.execute([&] { trace_photons(scene, goal.points, share_of({sent, until}, communicator), own); });
      communicator.all_sum(own.values());
      tally.take(own);
      turns.report(until, true, workers.progress);
      std::uint64_t asks = take_snapshot_request() ? 1 : 0;
      communicator.all_sum(std::span(&asks, 1));
      if (communicator.is_root() && (asks > 0 || turns.seconds() - kept >= keep_every)) {
        keep(tally);
        kept = turns.seconds();
      }
      if (anybody_stops(communicator)) {
        result.ending = PhotonEnding::signal;
        return false;
      }
    }
    return true;
  };

  if (result.restored > 0) look();
  for (bool goes_on = true; goes_on;) {
    const std::uint64_t sent = tally.count(PhotonCount::sent);
    const std::uint64_t next = turns.next(sent, result.ending);
    if (next <= sent) break;
    agree(communicator, [&] {
      if (!tally.has_room_for(next - sent))
        throw InputError(fmt::format("after {} photons their sums have no room for more in 62 bits", sent));
    });
    goes_on = send_until(next);
    if (tally.count(PhotonCount::sent) > sent) look();
  }
  result.reached = turns.reached();
  return result;
}

}  // namespace fluxel
