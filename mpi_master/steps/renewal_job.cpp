#include "mpi_master/steps/renewal_job.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>

#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/root_clock.hpp"
#include "mpi_master/steps/forecast.hpp"

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
        priority_(goal.groups, 0),
        clock_(workers.communicator) {
    result_.photons = goal.photons;
    result_.groups = goal.groups;
    result_.pilots = std::min(goal.photons, kPilotsOfGroup * goal.groups);
  }

  /// Collective: the first photons; they say which groups come first.
  void send_pilots() {
    std::vector<Indices> tasks;
    for (std::uint64_t first = 0; first < result_.pilots; first += kOfRenewalTask)
      tasks.push_back({first, std::min(first + kOfRenewalTask, result_.pilots), 1});
    result_.changed_pilots = renew(tasks);
    communicator_.all_sum(priority_);
    order_.resize(goal_.groups);
    std::iota(order_.begin(), order_.end(), std::uint64_t{0});
    std::ranges::stable_sort(order_, std::greater(), [&](std::uint64_t group) { return priority_[group]; });
    left_ = static_cast<double>(result_.changed_pilots) / static_cast<double>(result_.pilots) *
            static_cast<double>(goal_.photons - result_.pilots);
    record(result_.pilots, result_.changed_pilots, 0);
  }

  /// Collective: the next groups. False where none are left.
  bool renew_groups() {
    const RenewalTurn& last = result_.turns.back();
    const std::uint64_t count =
        std::min(std::max<std::uint64_t>(goal_.groups / kRenewalTurns, 1), goal_.groups - last.groups);
    if (count == 0) return false;
    std::vector<Indices> tasks;
    std::uint64_t renewed = last.renewed, priority = 0;
    for (std::uint64_t k = last.groups; k < last.groups + count; ++k) {
      const std::uint64_t group = order_[k];
      const std::uint64_t turns = (result_.pilots + goal_.groups - 1 - group) / goal_.groups;
      tasks.push_back({group + turns * goal_.groups, goal_.photons, goal_.groups});
      if (tasks.back().first < goal_.photons)
        renewed += (goal_.photons - tasks.back().first + goal_.groups - 1) / goal_.groups;
      priority += priority_[group];
    }
    if (result_.changed_pilots > 0)
      left_ -= static_cast<double>(priority) / static_cast<double>(result_.pilots) *
               static_cast<double>(goal_.photons - result_.pilots);
    const std::uint64_t changed = last.changed + renew(tasks);
    record(renewed, changed, last.groups + count);
    return true;
  }

  /// Collective: whether a limit or a signal ends it.
  [[nodiscard]] bool ends() {
    result_.complete = result_.turns.back().groups == goal_.groups;
    result_.stopped = anybody_stops(communicator_);
    return result_.complete || result_.stopped || (goal_.seconds && clock_.seconds() >= *goal_.seconds) ||
           (goal_.renewed && result_.turns.back().renewed >= *goal_.renewed);
  }

  void report(Progress& progress) const {
    const RenewalTurn& last = result_.turns.back();
    progress.update(static_cast<double>(last.renewed), static_cast<double>(goal_.photons),
                    fmt::format("{} of {} groups", last.groups, goal_.groups));
  }

  [[nodiscard]] double seconds() const { return clock_.own_seconds(); }
  [[nodiscard]] RenewalResult result() && { return std::move(result_); }

 private:
  /// Collective: how many have brought something else than before.
  std::uint64_t renew(const std::vector<Indices>& tasks) {
    const auto rank = static_cast<std::size_t>(communicator_.rank());
    const auto ranks = static_cast<std::size_t>(communicator_.size());
    std::atomic<std::uint64_t> changed = 0;
    const std::size_t mine = tasks.size() > rank ? (tasks.size() - rank + ranks - 1) / ranks : 0;
    arena_.execute([&] {
      tbb::parallel_for(std::size_t{0}, mine, [&](std::size_t k) {
        changed += renewal_.renew(tasks[rank + k * ranks], difference_, [&](std::uint64_t index) {
          if (index < result_.pilots)
            std::atomic_ref(priority_[index % goal_.groups]).fetch_add(1, std::memory_order_relaxed);
        });
      });
    });
    std::uint64_t all = changed;
    communicator_.all_sum(std::span(&all, 1));
    communicator_.all_sum(difference_.values());
    tally_.take(difference_);
    return all;
  }

  void record(std::uint64_t renewed, std::uint64_t changed, std::uint64_t groups) {
    result_.turns.push_back({renewed, changed, groups, std::max(left_, 0.0), clock_.own_seconds()});
  }

  const Communicator& communicator_;
  const PhotonRenewal& renewal_;
  const RenewalGoal& goal_;
  PhotonTally& tally_;
  PhotonTally difference_;
  tbb::task_arena arena_;
  std::vector<std::uint64_t> priority_;  // of each group
  std::vector<std::uint64_t> order_;     // of the groups
  double left_ = 0;
  RootClock clock_;
  RenewalResult result_;
};

}  // namespace

RenewalResult renew_photons(const Workers& workers, const PhotonRenewal& renewal, const RenewalGoal& goal,
                            PhotonTally& tally, const std::function<void(const PhotonTally&)>& show) {
  require_memory(workers.communicator, 8 * PhotonTally::size_of(tally.shape()), "the photons' sums",
                 "use larger elements, fewer ranks on a host, or --only receivers");
  Renewal job(workers, renewal, goal, tally);
  job.send_pilots();
  double shown = job.seconds();
  while (!job.ends() && job.renew_groups()) {
    job.report(workers.progress);
    if (workers.communicator.is_root() && job.seconds() - shown >= kShowEvery) {
      show(tally);
      shown = job.seconds();
    }
  }
  return std::move(job).result();
}

}  // namespace fluxel
