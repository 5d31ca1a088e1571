#include "mpi_master/steps/photon_job.hpp"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>

#include "core/signals.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/machine.hpp"
#include "mpi_master/communication/root_clock.hpp"
#include "mpi_master/steps/forecast.hpp"

namespace fluxel {

namespace {

/// Photons that turns are multiples of: even points are even by powers of two.
constexpr std::uint64_t kBlock = std::uint64_t{1} << 16;
constexpr std::uint64_t kFirstTurn = 4 * kBlock;
/// Some 20 s of a processor: so that a signal is heard.
constexpr std::uint64_t kMostOfTurn = std::uint64_t{1} << 24;

/// Differences of halves of fewer slots than that say too little of an error until they have said it often.
constexpr std::size_t kBelievedSlots = 16;

/// Of the points of a randomisation, whose index has 32 bits.
constexpr std::uint64_t kMostScrambled = std::uint64_t{kRandomisations} << 32;

class Turns {
 public:
  Turns(const Communicator& communicator, const PhotonGoal& goal, std::span<const PhotonKind> kinds,
        std::uint64_t restored)
      : limits_(goal.limits), kinds_(kinds), restored_(restored), clock_(communicator) {
    const bool is_limited = limits_.seconds || limits_.photons || limits_.received;
    if (!limits_.error.are_set() && !is_limited) limits_.error.target_error = kReferenceError;
  }

  /// Looks at what there is after a turn.
  void look(const PhotonTurn& turn, const PhotonTally& tally) {
    excess_ = 0;
    relative_ = 0;
    std::size_t least_slots = kBelievedSlots;
    received_ = 0;
    for (std::size_t k = 0; k < kinds_.size(); ++k) {
      if (!kinds_[k].decides) continue;
      received_ += tally.received(kinds_[k].received);
      const double relative = relative_error(turn.errors[k]);
      const double excess = limits_.error.excess(relative, absolute_error(turn.errors[k]));
      if (excess >= excess_) excess_ = excess, relative_ = relative;
      if (tally.shape().parts == 2 && !kinds_[k].slots.has_squares)
        least_slots = std::min(least_slots, std::max<std::size_t>(measured_slots(kinds_[k]), 1));
    }
    const bool is_good = limits_.error.are_set() && excess_ <= 1;
    good_turns_ = is_good ? good_turns_ + 1 : 0;
    is_believed_ = good_turns_ * least_slots >= kBelievedSlots;
  }

  /// Collective: how many photons there are after the next turn; `sent` where there is none, and then
  /// `ending` says why.
  std::uint64_t next(std::uint64_t sent, PhotonEnding& ending) const {
    double next = sent < kFirstTurn
                      ? static_cast<double>(kFirstTurn)
                      : static_cast<double>(after(sent, std::min(std::bit_floor(sent) / 4, kMostOfTurn)));
    ending = PhotonEnding::target;
    const auto limit = [&](double most, PhotonEnding end) {
      if (most > next) return;
      next = most;
      if (most <= static_cast<double>(sent)) ending = end;
    };
    if (sent > 0 && is_believed_) limit(static_cast<double>(sent), PhotonEnding::target);
    // By 1 / sqrt(photons), and a hundredth more: else the last turn would go well beyond the target.
    if (sent > 0 && excess_ > 1)
      next = std::min(next, in_blocks(1.01 * static_cast<double>(sent) * excess_ * excess_, sent));
    if (limits_.received && sent > 0) {
      if (received_ >= *limits_.received)
        limit(static_cast<double>(sent), PhotonEnding::received);
      else if (received_ > 0)
        next = std::min(next, in_blocks(static_cast<double>(sent) * static_cast<double>(*limits_.received) /
                                            static_cast<double>(received_),
                                        sent));
    }
    if (limits_.photons) limit(static_cast<double>(*limits_.photons), PhotonEnding::photons);
    if (limits_.seconds) {
      const double seconds = clock_.seconds();  // collective
      if (sent > restored_) {
        const double each = seconds / static_cast<double>(sent - restored_);
        const double left = std::floor((*limits_.seconds - seconds) / each / static_cast<double>(kBlock));
        limit(static_cast<double>(sent) + std::max(0.0, left) * static_cast<double>(kBlock),
              PhotonEnding::time);
      }
    }
    return std::max(static_cast<std::uint64_t>(next), sent);
  }

  /// `done`: photons, in the midst of a turn.
  void report(double done, Progress& progress) const {
    const std::string detail = fmt::format("{:.4g} photons", done);
    if (limits_.error.are_set()) {
      // What is asked for, as a relative error.
      const bool is_known = excess_ > 0;
      const double target =
          is_known ? relative_ / excess_ : limits_.error.target_error.value_or(kReferenceError);
      const double error = is_known ? relative_ : std::numeric_limits<double>::infinity();
      progress.update_error({done, error, target, ErrorLaw::sampling}, detail);
    } else if (limits_.seconds) {
      progress.update(std::min(clock_.own_seconds(), *limits_.seconds), *limits_.seconds, detail);
    } else if (limits_.photons) {
      progress.update(done, static_cast<double>(*limits_.photons), detail);
    }
  }

  [[nodiscard]] bool reached() const { return excess_ <= 1; }
  /// By this rank's clock.
  [[nodiscard]] double seconds() const { return clock_.own_seconds(); }

 private:
  static std::uint64_t after(std::uint64_t sent, std::uint64_t step) {
    step = std::max(step, kBlock);
    return sent - sent % step + step;
  }
  /// The next multiple of a block that is at least that, and more than there is.
  static double in_blocks(double photons, std::uint64_t sent) {
    const double blocks = std::ceil(photons / static_cast<double>(kBlock));
    return std::max(blocks * static_cast<double>(kBlock), static_cast<double>(after(sent, kBlock)));
  }
  static std::size_t measured_slots(const PhotonKind& kind) {
    return static_cast<std::size_t>(
        std::ranges::count_if(kind.slots.areas, [](double area) { return area > 0; }));
  }

  PhotonLimits limits_;
  std::span<const PhotonKind> kinds_;
  std::uint64_t restored_;
  RootClock clock_;
  double excess_ = 0;    // of the worst error over what is asked for; 0: not known yet
  double relative_ = 0;  // that error over its mean
  std::uint64_t received_ = 0;
  std::size_t good_turns_ = 0;  // one after another
  bool is_believed_ = false;
};

double largest(const Rgb& of) { return std::max({of.r, of.g, of.b}); }

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

double absolute_error(const IrradianceErrors& errors) { return largest(errors.error); }

std::string refused_photons(const PhotonGoal& goal) {
  const bool is_scrambled = goal.points.sequence == Sequence::scrambled;
  const std::uint64_t most = is_scrambled ? kMostScrambled : PhotonTally::kMostPhotons;
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
  Turns turns(communicator, goal, kinds, result.restored);
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
  };
  if (result.restored > 0) look();
  for (;;) {
    const std::uint64_t sent = tally.count(PhotonCount::sent);
    const std::uint64_t next = turns.next(sent, result.ending);
    if (next <= sent) break;
    agree(communicator, [&] {
      if (!tally.has_room_for(next - sent))
        throw InputError(fmt::format("after {} photons their sums have no room for more in 62 bits", sent));
    });
    const PhotonRange mine = share_of({sent, next}, communicator);
    for (std::uint64_t first = mine.first; first < mine.last; first += kBlock) {
      const PhotonRange some{first, std::min(first + kBlock, mine.last)};
      arena.execute([&] { trace_photons(scene, goal.points, some, own); });
      const double part =
          static_cast<double>(some.last - mine.first) / static_cast<double>(mine.last - mine.first);
      turns.report(static_cast<double>(sent) + part * static_cast<double>(next - sent), workers.progress);
    }
    communicator.all_sum(own.values());
    tally.take(own);
    look();
    turns.report(static_cast<double>(next), workers.progress);
    std::uint64_t asks = take_snapshot_request() ? 1 : 0;
    communicator.all_sum(std::span(&asks, 1));
    if (communicator.is_root() && (asks > 0 || turns.seconds() - kept >= keep_every)) {
      keep(tally);
      kept = turns.seconds();
    }
    if (anybody_stops(communicator)) {
      result.ending = PhotonEnding::signal;
      break;
    }
  }
  result.reached = turns.reached();
  return result;
}

}  // namespace fluxel
