#pragma once

#include <cstdint>
#include <span>

#include "core/progress.hpp"
#include "mpi_master/communication/root_clock.hpp"
#include "mpi_master/steps/photon_job.hpp"

namespace fluxel {

/// When photons are enough, and how many are sent at a time. Errors are looked at where a turn ends, which
/// depends on the number of photons alone, so that clocks do not decide on the result; time and signals are
/// looked at after each part of a turn.
class PhotonTurns {
 public:
  /// What is given must outlive this. `restored`: photons of earlier jobs.
  PhotonTurns(const Communicator& communicator, const PhotonGoal& goal, std::span<const PhotonKind> kinds,
              std::uint64_t restored);

  /// Looks at the errors that there are.
  void look(const PhotonTurn& turn, const PhotonTally& tally);

  /// How many photons there are when the next turn ends; `sent` where there is none, and then `ending` says
  /// why.
  [[nodiscard]] std::uint64_t next(std::uint64_t sent, PhotonEnding& ending) const;

  /// Collective: of a turn that ends at `next`, how many there are after its next part, of some seconds;
  /// `sent` where the time is up.
  [[nodiscard]] std::uint64_t next_part(std::uint64_t sent, std::uint64_t next) const;

  /// `is_part`: the turn has not ended; then the error is the last turn's and says nothing of so many, so
  /// that of errors the first turn alone says how far it is.
  void report(std::uint64_t sent, bool is_part, Progress& progress) const;

  /// Whether the errors that were asked for are known and reached.
  [[nodiscard]] bool reached() const { return excess_ <= 1 && !is_unknown_; }
  /// By this rank's clock.
  [[nodiscard]] double seconds() const { return clock_.own_seconds(); }

 private:
  PhotonLimits limits_;
  ErrorLaw law_;
  std::uint64_t most_;  // that there are points for
  std::span<const PhotonKind> kinds_;
  std::uint64_t restored_;
  RootClock clock_;
  double excess_ = 0;        // of the worst error over what is asked for; 0: not known yet
  double relative_ = 0;      // that error over its mean
  bool is_unknown_ = false;  // nothing has come to a kind whose error is asked for
  std::uint64_t received_ = 0;
  double good_slots_ = 0;  // how many slots have said one turn after another that the errors are reached
};

}  // namespace fluxel
