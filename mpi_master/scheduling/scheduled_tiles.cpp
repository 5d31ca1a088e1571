#include "mpi_master/scheduling/scheduled_tiles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <optional>

#include "mpi_master/scheduling/back_off.hpp"
#include "mpi_master/scheduling/schedule_progress.hpp"
#include "visibility/tile.hpp"

namespace fluxel {

namespace {

enum ScheduleTag : int { kAsk = 1, kStrip = 2, kStopWish = 3, kStop = 4 };

constexpr std::uint64_t kMaxTilesPerBatch = 32768;  // several launches of a GPU, at most 16 MB of codes
/// The next strip is asked for when this many batches are left of a strip: rank 0 answers within one or two.
constexpr std::uint64_t kBatchesAhead = 4;

/// Where the time goes: every moment belongs to one kind.
class TimeBook {
 public:
  explicit TimeBook(int rank) : rank_(rank) {}

  /// The time since the last call was spent so.
  void spend(ActivityKind kind) {
    const double now = std::chrono::duration<double>(Clock::now() - start_).count();
    seconds_[static_cast<std::size_t>(kind)] += now - last_;
    // What is short is not worth a stretch of its own.
    if (!spans_.empty() && (spans_.back().kind == kind || now - last_ < shortest_)) {
      spans_.back().end = now;
    } else {
      spans_.push_back({rank_, kind, last_, now});
      // Nor is any, the longer a job goes on.
      if (spans_.size() % kMaxAtOneLength == 0) shortest_ *= 2;
    }
    last_ = now;
  }

  [[nodiscard]] double seconds(ActivityKind kind) const { return seconds_[static_cast<std::size_t>(kind)]; }
  /// Until the last call of spend.
  [[nodiscard]] double all_seconds() const { return last_; }
  [[nodiscard]] const std::vector<ActivitySpan>& spans() const { return spans_; }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kMaxAtOneLength = 10'000;

  int rank_;
  Clock::time_point start_ = Clock::now();
  double last_ = 0;
  double shortest_ = 1e-3;  // [s]
  std::array<double, 3> seconds_{};
  std::vector<ActivitySpan> spans_;
};

/// One rank's part in the job. Messages: a rank asks rank 0, which answers with a strip (an empty one: no
/// more); a rank that wishes to stop notifies rank 0, which notifies all; all else is the work's.
class Worker {
 public:
  Worker(const Workers& workers, StripScheduler& scheduler, TileWork& work)
      : communicator_(workers.communicator),
        scheduler_(scheduler),
        threads_(static_cast<std::uint64_t>(workers.threads)),
        work_(work),
        progress_(workers.progress),
        tiles_per_batch_(16 * threads_),
        sent_before_(communicator_.sent()),
        schedule_(communicator_.size()) {}

  ScheduleRecord run() {
    communicator_.barrier();  // clocks of all ranks begin together
    book_.emplace(communicator_.rank());
    while (!finished() && !stopped_) {
      if (!wished_ && work_.between_batches()) wish_to_stop();
      handle_messages();
      book_->spend(ActivityKind::messages);
      if (current_.size() == 0 && next_ && work_.prepared()) {
        current_ = *next_;
        next_.reset();
        ++activity_.strips;
        work_.begin(current_);
      }
      ask_in_time();
      if (current_.size() > 0) {
        compute_batch();
        pause_.reset();
      } else {
        pause_.wait();
        book_->spend(ActivityKind::wait);
      }
    }
    // Nothing is sent from here on, and nothing may stay under way: a stop, or a wish for one, may have come
    // late.
    ended_ = true;
    work_.end();
    communicator_.receive_all([this](const Message& message) { handle(message); });
    book_->spend(ActivityKind::wait);
    return summary();
  }

 private:
  void ask_in_time() {
    if (asked_ || next_ || no_more_ || current_.size() > kBatchesAhead * tiles_per_batch_) return;
    if (communicator_.is_root()) {
      const TileRange strip = scheduler_.next(0).value_or(TileRange{});
      own_cost_ += scheduler_.cost(strip);
      take_strip(strip);
    } else {
      asked_ = true;
      communicator_.send(0, kAsk, {});
    }
  }

  void take_strip(const TileRange& strip) {
    if (stopped_) return;
    asked_ = false;
    if (strip.size() == 0) {
      no_more_ = true;
    } else {
      next_ = strip;
      work_.prepare(strip);
    }
  }

  void wish_to_stop() {
    wished_ = true;
    if (communicator_.is_root()) {
      stop_all();
    } else {
      communicator_.send(0, kStopWish, {});
    }
  }

  /// On rank 0. When it has ended itself, all strips are assigned and the job is about to end.
  void stop_all() {
    if (stopped_ || ended_) return;
    stopped_ = true;
    for (int rank = 1; rank < communicator_.size(); ++rank) communicator_.send(rank, kStop, {});
  }

  void answer(int rank) {
    if (stopped_) return;
    const TileRange strip = scheduler_.next(rank).value_or(TileRange{});
    if (strip.size() == 0) ++dismissed_;
    schedule_.assign(rank, scheduler_.cost(strip), book_->all_seconds());
    const auto bytes = std::as_bytes(std::span(&strip, 1));
    communicator_.send(rank, kStrip, Bytes(bytes.begin(), bytes.end()));
  }

  /// Whether there were any.
  bool handle_messages() {
    bool any = false;
    while (const auto message = communicator_.receive()) {
      any = true;
      pause_.reset();
      handle(*message);
    }
    return any;
  }

  void handle(const Message& message) {
    switch (message.tag) {
      case kAsk:
        return answer(message.source);
      case kStrip: {
        TileRange strip;
        std::memcpy(&strip, message.data.data(), sizeof strip);
        return take_strip(strip);
      }
      case kStopWish:
        return stop_all();
      case kStop:
        stopped_ = true;
        return;
      default:
        work_.take(message);
    }
  }

  /// Some tiles of the current strip, then what they gave is sent off.
  void compute_batch() {
    const TileRange batch{current_.first, std::min(current_.last, current_.first + tiles_per_batch_)};
    const double before = book_->seconds(ActivityKind::compute);
    const std::uint64_t done = work_.compute(batch);
    book_->spend(ActivityKind::compute);
    current_.first += done;
    activity_.tiles += done;
    const double seconds = book_->seconds(ActivityKind::compute) - before;
    // Tiles of one strip cost up to a hundred times those of another.
    const double wanted = work_.batch_seconds();
    if (seconds > 1.5 * wanted) {
      tiles_per_batch_ = std::max(threads_, tiles_per_batch_ / 2);
    } else if (seconds < wanted / 1.5 && done == tiles_per_batch_) {
      tiles_per_batch_ = std::min(kMaxTilesPerBatch, 2 * tiles_per_batch_);
    }
    work_.deliver();
    // What leaves slower than it is made would fill the memory.
    while (communicator_.pending_sends() > kMaxPendingSends)
      if (!handle_messages()) pause_.wait();
    book_->spend(ActivityKind::messages);
    report_progress();
  }

  [[nodiscard]] bool finished() {
    const bool all_notified = !communicator_.is_root() || dismissed_ == communicator_.size() - 1;
    return no_more_ && current_.size() == 0 && all_notified && work_.complete() &&
           communicator_.pending_sends() == 0;
  }

  void report_progress() {
    if (!communicator_.is_root()) return;
    const double seconds = book_->all_seconds();
    const double assigned = scheduler_.cost(current_) + scheduler_.cost(next_.value_or(TileRange{}));
    const double own = std::max(0.0, own_cost_ - assigned);  // which rounding may put below 0
    constexpr double kPairsPerTile = kTileSize * kTileSize;
    const double pairs = kPairsPerTile * static_cast<double>(scheduler_.tiles_assigned());
    progress_.update(own + schedule_.done_by_others(seconds), scheduler_.cost_to_assign(),
                     fmt::format("{:.0f} million pairs/s", pairs / seconds * 1e-6));
  }

  ScheduleRecord summary() {
    activity_.busy_seconds = book_->seconds(ActivityKind::compute);
    activity_.message_seconds = book_->seconds(ActivityKind::messages);
    activity_.waiting_seconds = book_->seconds(ActivityKind::wait);
    activity_.messages_sent = communicator_.sent().messages - sent_before_.messages;
    activity_.bytes_sent = communicator_.sent().bytes - sent_before_.bytes;
    return {communicator_.all_gather(std::span<const Activity>(&activity_, 1)), book_->spans(), stopped_};
  }

  const Communicator& communicator_;
  StripScheduler& scheduler_;
  std::uint64_t threads_;
  TileWork& work_;
  Progress& progress_;
  std::uint64_t tiles_per_batch_;
  SentCounts sent_before_;
  std::optional<TimeBook> book_;
  ScheduleProgress schedule_;  // on rank 0
  double own_cost_ = 0;        // of what rank 0 has assigned itself
  Activity activity_;
  TileRange current_;              // what is left of it
  std::optional<TileRange> next_;  // asked for ahead
  bool asked_ = false;             // and not answered
  bool no_more_ = false;
  int dismissed_ = 0;     // ranks that know that there is no more
  bool wished_ = false;   // to stop
  bool stopped_ = false;  // all have been notified
  bool ended_ = false;    // this rank has no part any more
  BackOff pause_;
};

}  // namespace

ScheduleRecord schedule_tiles(const Workers& workers, StripScheduler& scheduler, TileWork& work) {
  return Worker(workers, scheduler, work).run();
}

}  // namespace fluxel
