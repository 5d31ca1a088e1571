#include "mpi_master/steps/photon_turns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/options.hpp"

namespace fluxel {

namespace {

/// Photons that turns are multiples of: even points are even by powers of two.
constexpr std::uint64_t kBlock = std::uint64_t{1} << 16;
constexpr std::uint64_t kFirstTurn = 4 * kBlock;
constexpr std::uint64_t kMostOfTurn = std::uint64_t{1} << 24;

/// The first part of a job, before its pace is known; then parts take some seconds, so that signals are
/// heard.
constexpr std::uint64_t kFirstPart = std::uint64_t{1} << 13;
constexpr double kPartSeconds = 3;

/// Differences of halves of fewer slots than that say too little of an error until they have said it often.
constexpr double kBelievedSlots = 16;

/// Where none of so many has come nobody waits for the next.
constexpr std::uint64_t kInVain = std::uint64_t{1} << 26;

/// The next multiple of a step.
std::uint64_t after(std::uint64_t sent, std::uint64_t step) {
  step = std::max(step, kBlock);
  return sent - sent % step + step;
}

/// The next multiple of a block that is at least that, and more than there is.
double in_blocks(double photons, std::uint64_t sent) {
  const auto block = static_cast<double>(kBlock);
  return std::max(std::ceil(photons / block) * block, static_cast<double>(after(sent, kBlock)));
}

/// Slots that would tell as much of the error, were the light evenly over them.
double telling_slots(const PhotonKind& kind, const IrradianceErrors& errors) {
  const auto slots =
      static_cast<double>(std::ranges::count_if(kind.slots.areas, [](double area) { return area > 0; }));
  const double mean = mean_of_colours(errors.mean), quadratic = mean_of_colours(errors.quadratic_mean);
  return std::max(1.0, quadratic > 0 ? slots * (mean * mean) / (quadratic * quadratic) : 1.0);
}

}  // namespace

PhotonTurns::PhotonTurns(const Communicator& communicator, const PhotonGoal& goal,
                         std::span<const PhotonKind> kinds, std::uint64_t restored)
    : limits_(goal.limits),
      law_(goal.points.sequence == Sequence::random ? ErrorLaw::sampling : ErrorLaw::power),
      most_(most_photons(goal.points.sequence)),
      kinds_(kinds),
      restored_(restored),
      clock_(communicator) {
  const bool is_limited = limits_.seconds || limits_.photons || limits_.received;
  if (!limits_.error.are_set() && !is_limited) limits_.error.target_error = kReferenceError;
}

void PhotonTurns::look(const PhotonTurn& turn, const PhotonTally& tally) {
  excess_ = 0;
  relative_ = 0;
  is_unknown_ = false;
  received_ = 0;
  double least_slots = kBelievedSlots;
  for (std::size_t k = 0; k < kinds_.size(); ++k) {
    if (!kinds_[k].decides) continue;
    const std::uint64_t received = tally.received(kinds_[k].received);
    received_ += received;
    if (received == 0) {
      is_unknown_ = limits_.error.are_set();
      continue;
    }
    const double relative = relative_error(turn.errors[k]);
    const double excess = limits_.error.excess(relative, absolute_error(turn.errors[k]));
    if (excess >= excess_) excess_ = excess, relative_ = relative;
    if (tally.shape().parts == 2 && !kinds_[k].slots.has_squares)
      least_slots = std::min(least_slots, telling_slots(kinds_[k], turn.errors[k]));
  }
  const bool is_good = limits_.error.are_set() && received_ > 0 && excess_ <= 1;
  good_slots_ = is_good ? good_slots_ + least_slots : 0;
}

std::uint64_t PhotonTurns::next(std::uint64_t sent, PhotonEnding& ending) const {
  const auto there = static_cast<double>(sent);
  double next = static_cast<double>(
      sent < kFirstTurn ? kFirstTurn : after(sent, std::min(std::bit_floor(sent) / 4, kMostOfTurn)));
  ending = PhotonEnding::target;
  const auto limit = [&](std::uint64_t most, PhotonEnding end) {
    if (static_cast<double>(most) > next) return;
    next = static_cast<double>(most);
    if (most <= sent) ending = end;
  };
  if (good_slots_ >= kBelievedSlots) limit(sent, PhotonEnding::target);
  if (received_ == 0 && sent >= kInVain && (limits_.error.are_set() || limits_.received))
    limit(sent, PhotonEnding::vain);
  // By 1 / sqrt(photons), and a hundredth more: else the last turn would go well beyond the target.
  if (excess_ > 1) next = std::min(next, in_blocks(1.01 * there * excess_ * excess_, sent));
  if (limits_.received && received_ >= *limits_.received) limit(sent, PhotonEnding::received);
  if (limits_.received && received_ > 0)
    next = std::min(
        next,
        in_blocks(there * static_cast<double>(*limits_.received) / static_cast<double>(received_), sent));
  limit(limits_.photons.value_or(most_), PhotonEnding::photons);
  limit(most_, PhotonEnding::photons);
  return std::max(static_cast<std::uint64_t>(next), sent);
}

std::uint64_t PhotonTurns::next_part(std::uint64_t sent, std::uint64_t next) const {
  const double seconds = clock_.seconds();
  if (limits_.seconds && seconds >= *limits_.seconds && sent > restored_) return sent;
  if (sent == restored_) return std::min(next, sent + kFirstPart);
  const double left = limits_.seconds ? std::min(kPartSeconds, *limits_.seconds - seconds) : kPartSeconds;
  const double photons = left * static_cast<double>(sent - restored_) / std::max(seconds, 1e-3);
  // At most ten times what there has been, as the pace of a few may mislead.
  const double most = 10 * static_cast<double>(sent - restored_);
  return std::min(next, sent + std::max(kFirstPart, static_cast<std::uint64_t>(std::min(photons, most))));
}

void PhotonTurns::report(std::uint64_t sent, bool is_part, Progress& progress) const {
  const auto done = static_cast<double>(sent);
  const std::string detail = fmt::format("{:.4g} photons", done);
  if (limits_.error.are_set()) {
    if (is_part && excess_ > 0) return;
    const double error = excess_ > 0 ? relative_ : std::numeric_limits<double>::infinity();
    progress.update_error({done, error, limits_.error.as_relative(relative_, excess_), law_}, detail);
  } else if (limits_.seconds) {
    progress.update(std::min(seconds(), *limits_.seconds), *limits_.seconds, detail);
  } else if (limits_.photons) {
    progress.update(done, static_cast<double>(*limits_.photons), detail);
  } else if (limits_.received) {
    progress.update(static_cast<double>(received_), static_cast<double>(*limits_.received), detail);
  }
}

}  // namespace fluxel
