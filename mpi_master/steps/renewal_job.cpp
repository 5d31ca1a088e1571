#include "mpi_master/steps/renewal_job.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <functional>
#include <numeric>

#include "core/signals.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/root_clock.hpp"
#include "mpi_master/steps/forecast.hpp"
#include "photons/photon_groups.hpp"

namespace fluxel {

namespace {

constexpr std::uint64_t kPilotsOfGroup = 4;
constexpr std::uint64_t kOfRenewalTask = 1024;
constexpr std::uint64_t kRenewalTurns = 128;
constexpr double kShowEvery = 5;  // [s]

using Indices = PhotonRenewal::Indices;

class Renewal {
 public:
  Renewal(const Workers& workers, const PhotonRenewal& renewal, const RenewalGoal& goal, PhotonTally& tally)
      : communicator_(workers.communicator),
        renewal_(renewal),
        goal_(goal),
        tally_(tally),
        difference_(tally.shape()),
        arena_(workers.threads),
        groups_(goal.partings.back()),
        counts_{std::vector<std::uint64_t>(groups_, 0), std::vector<std::uint64_t>(groups_, 0)},
        is_renewed_(groups_, false),
        clock_(workers.communicator) {
    result_.photons = goal.photons;
    result_.groups = groups_;
    result_.pilots = std::min(goal.photons, kPilotsOfGroup * groups_);
  }

  /// Collective: the first photons; they say which groups come first.
  void send_pilots() {
    std::vector<Indices> tasks;
    for (std::uint64_t first = 0; first < result_.pilots; first += kOfRenewalTask)
      tasks.push_back({first, std::min(first + kOfRenewalTask, result_.pilots), 1});
    result_.changed_pilots = renew(tasks);
    for (std::uint64_t group = 0; group < groups_; ++group) counts_.gone[group] = pilots_of(group);
    sort_groups();
    record(result_.pilots, result_.changed_pilots, 0);
  }

  /// Collective: the next groups. False where none are left.
  bool renew_groups() {
    const RenewalTurn& last = result_.turns.back();
    const std::uint64_t count =
        std::min(std::max<std::uint64_t>(groups_ / kRenewalTurns, 1), groups_ - last.groups);
    if (count == 0) return false;
    std::vector<Indices> tasks;
    std::uint64_t renewed = last.renewed;
    for (std::uint64_t k = 0; k < count; ++k) {
      const std::uint64_t group = order_[next_ + k];
      for (std::uint64_t first = group + pilots_of(group) * groups_; first < goal_.photons;
           first += kOfRenewalTask * groups_)
        tasks.push_back({first, std::min(first + kOfRenewalTask * groups_, goal_.photons), groups_});
      renewed += left_of(group);
      counts_.gone[group] += left_of(group);
      is_renewed_[group] = true;
    }
    next_ += count;
    const std::uint64_t changed = last.changed + renew(tasks);
    // What they have told serves the others: not each time, as groups may be many.
    if (std::has_single_bit(result_.turns.size())) sort_groups();
    record(renewed, changed, last.groups + count);
    return true;
  }

  /// Collective: whether a limit or a signal ends it.
  [[nodiscard]] bool ends() {
    const RenewalTurn& last = result_.turns.back();
    if (last.groups == groups_) return true;
    const bool is_late = goal_.seconds && clock_.seconds() >= *goal_.seconds;
    if (is_late) result_.ending = PhotonEnding::time;
    if (goal_.renewed && last.renewed >= *goal_.renewed) result_.ending = PhotonEnding::photons;
    if (anybody_stops(communicator_)) result_.ending = PhotonEnding::signal;
    return result_.ending != PhotonEnding::renewed;
  }

  void report(Progress& progress) const {
    const RenewalTurn& last = result_.turns.back();
    progress.update(static_cast<double>(last.renewed), static_cast<double>(goal_.photons),
                    fmt::format("{} of {} groups", last.groups, groups_));
  }

  [[nodiscard]] double seconds() const { return clock_.own_seconds(); }
  [[nodiscard]] RenewalResult result() && { return std::move(result_); }

 private:
  /// Collective: how many have brought something else than before.
  std::uint64_t renew(const std::vector<Indices>& tasks) {
    const auto rank = static_cast<std::size_t>(communicator_.rank());
    const auto ranks = static_cast<std::size_t>(communicator_.size());
    found_.assign(groups_, 0);
    const std::size_t mine = tasks.size() > rank ? (tasks.size() - rank + ranks - 1) / ranks : 0;
    arena_.execute([&] {
      tbb::parallel_for(std::size_t{0}, mine, [&](std::size_t k) {
        renewal_.renew(tasks[rank + k * ranks], difference_, [&](std::uint64_t index) {
          std::atomic_ref(found_[index % groups_]).fetch_add(1, std::memory_order_relaxed);
        });
      });
    });
    communicator_.all_sum(found_);
    for (std::uint64_t group = 0; group < groups_; ++group) counts_.changed[group] += found_[group];
    communicator_.all_sum(difference_.values());
    tally_.take(difference_);
    return std::accumulate(found_.begin(), found_.end(), std::uint64_t{0});
  }

  [[nodiscard]] std::uint64_t pilots_of(std::uint64_t group) const {
    return (result_.pilots + groups_ - 1 - group) / groups_;
  }
  /// Photons of a group that are no pilots.
  [[nodiscard]] std::uint64_t left_of(std::uint64_t group) const {
    return (goal_.photons + groups_ - 1 - group) / groups_ - pilots_of(group);
  }

  /// Those that are left, the most changed ones first.
  void sort_groups() {
    shares_ = expected_shares(goal_.partings, counts_);
    order_.clear();
    for (std::uint64_t group = 0; group < groups_; ++group)
      if (!is_renewed_[group]) order_.push_back(group);
    std::ranges::stable_sort(order_, std::greater(), [&](std::uint64_t group) { return shares_[group]; });
    next_ = 0;
  }
  /// Photons that still bring what they did before, where so many have been found that do not. By the groups
  /// that are left alone they would be too few: these come last because few of their pilots had changed, by
  /// chance too. All pilots together know nothing of the order.
  [[nodiscard]] double expected_left(std::uint64_t changed) const {
    if (next_ == order_.size()) return 0;
    const double share = static_cast<double>(result_.changed_pilots) / static_cast<double>(result_.pilots);
    double left = 0;
    for (std::size_t k = next_; k < order_.size(); ++k)
      left += shares_[order_[k]] * static_cast<double>(left_of(order_[k]));
    return std::max(left, share * static_cast<double>(goal_.photons) - static_cast<double>(changed));
  }

  void record(std::uint64_t renewed, std::uint64_t changed, std::uint64_t groups) {
    result_.turns.push_back({renewed, changed, groups, expected_left(changed), clock_.own_seconds()});
  }

  const Communicator& communicator_;
  const PhotonRenewal& renewal_;
  const RenewalGoal& goal_;
  PhotonTally& tally_;
  PhotonTally difference_;
  tbb::task_arena arena_;
  std::uint64_t groups_;
  GroupCounts counts_;
  std::vector<bool> is_renewed_;      // of each group
  std::vector<std::uint64_t> found_;  // changed photons of each group in this turn
  std::vector<double> shares_;        // expected of each group
  std::vector<std::uint64_t> order_;  // of the groups that are left
  std::size_t next_ = 0;              // in it
  RootClock clock_;
  RenewalResult result_;
};

}  // namespace

RenewalResult renew_photons(const Workers& workers, const PhotonRenewal& renewal, const RenewalGoal& goal,
                            PhotonTally& tally, const std::function<void(const PhotonTally&)>& show) {
  constexpr std::uint64_t kBytesOfGroup = 64;
  require_memory(
      workers.communicator, 8 * PhotonTally::size_of(tally.shape()) + kBytesOfGroup * goal.partings.back(),
      "the photons' sums", "use larger elements, fewer ranks on a host, fewer --groups, or --only receivers");
  Renewal job(workers, renewal, goal, tally);
  job.send_pilots();
  double shown = job.seconds();
  while (!job.ends() && job.renew_groups()) {
    job.report(workers.progress);
    std::uint64_t asks = take_snapshot_request() ? 1 : 0;
    workers.communicator.all_sum(std::span(&asks, 1));
    if (workers.communicator.is_root() && (asks > 0 || job.seconds() - shown >= kShowEvery)) {
      show(tally);
      shown = job.seconds();
    }
  }
  return std::move(job).result();
}

}  // namespace fluxel
