#include "bench/simulate/engine.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <queue>

namespace fluxel::bench {

namespace {

// As in mpi_master/scheduling/scheduled_tiles.cpp.
constexpr double kBatchSeconds = 2e-3;
constexpr std::uint64_t kMaxTilesPerBatch = 4096;
constexpr std::uint64_t kFirstBatch = 16;
constexpr std::uint64_t kBatchesAhead = 4;
// As in mpi_master/back_off.hpp [s].
constexpr double kShortestPause = 20e-6, kLongestPause = 500e-6, kPausePart = 0.1;

constexpr double kStripBytes = sizeof(TileRange);

enum class Kind : std::uint8_t { ask, strip, tiles };

struct SimulatedMessage {
  Kind kind = Kind::ask;
  int source = 0;
  TileRange strip;  // empty: there is no more
  double tiles = 0, bytes = 0;
};

enum class EventKind : std::uint8_t { step, computed, reach, arrival };

struct Event {
  double time = 0;
  std::uint64_t number = 0;  // of events at one time the one that was made first comes first
  EventKind kind = EventKind::step;
  int rank = 0;
  SimulatedMessage message;

  bool operator>(const Event& other) const {
    return time > other.time || (time == other.time && number > other.number);
  }
};

struct SimulatedRank {
  TileRange current;
  std::optional<TileRange> next;
  bool asked = false, no_more = false;
  bool asleep = false;  // no event of its own is due
  double slept_since = 0;
  std::uint64_t tiles_per_batch = kFirstBatch;
  std::uint64_t batch_size = 0;
  Batch batch;
  std::deque<SimulatedMessage> inbox;
};

class Job {
 public:
  Job(SimulatedWork& work, const JobSettings& settings)
      : work_(work),
        settings_(settings),
        traffic_(settings.network, static_cast<int>(settings.speed.size())),
        ranks_(settings.speed.size()),
        times_(settings.speed.size()) {}

  JobResult run() {
    for (int rank = 0; rank < ranks(); ++rank) push(0, EventKind::step, rank);
    while (!events_.empty()) {
      const Event event = events_.top();
      events_.pop();
      if (event.kind == EventKind::step) {
        step(event.rank, event.time);
      } else if (event.kind == EventKind::computed) {
        deliver(event.rank, event.time);
      } else if (event.kind == EventKind::reach) {
        push(traffic_.arrival(event.rank, event.message.bytes, event.time), EventKind::arrival, event.rank,
             event.message);
      } else {
        arrive(event.rank, event.message, event.time);
      }
    }
    return result();
  }

 private:
  [[nodiscard]] int ranks() const { return static_cast<int>(ranks_.size()); }
  SimulatedRank& at(int rank) { return ranks_[static_cast<std::size_t>(rank)]; }
  RankTimes& times(int rank) { return times_[static_cast<std::size_t>(rank)]; }

  void push(double time, EventKind kind, int rank, const SimulatedMessage& message = {}) {
    events_.push({time, event_count_++, kind, rank, message});
  }

  void send(int from, int to, const SimulatedMessage& message, double& now) {
    now += settings_.costs.send;
    ++times(from).messages_sent;
    times(from).bytes_sent += message.bytes;
    if (traffic_.same_host(from, to)) {
      push(traffic_.arrival_within_host(message.bytes, now), EventKind::arrival, to, message);
    } else {
      push(traffic_.reach(from, message.bytes, now), EventKind::reach, to, message);
    }
  }

  /// Once round a rank's loop, up to the end of its batch or to sleep.
  void step(int number, double start) {
    SimulatedRank& rank = at(number);
    double now = start;
    if (!rank.inbox.empty()) {
      while (!rank.inbox.empty()) {
        const SimulatedMessage message = rank.inbox.front();
        rank.inbox.pop_front();
        take(number, message, now);
      }
      // More may have come meanwhile.
      return continue_after_messages(number, start, now);
    }
    if (rank.current.size() == 0 && rank.next) {
      rank.current = *rank.next;
      rank.next.reset();
      ++times(number).strips;
    }
    ask_in_time(number, now);
    times(number).messages += now - start;
    if (rank.current.size() > 0) {
      begin_batch(number, now);
    } else {
      rank.asleep = true;
      rank.slept_since = now;
      if (rank.next) wake(number, now);  // rank 0 asks nobody, but looks only after a first pause
    }
  }

  void continue_after_messages(int rank, double start, double now) {
    times(rank).messages += now - start;
    times(rank).end = now;
    push(now, EventKind::step, rank);
  }

  void take(int number, const SimulatedMessage& message, double& now) {
    SimulatedRank& rank = at(number);
    now += settings_.costs.receive;
    if (message.kind == Kind::ask) {
      now += settings_.costs.decision;
      const TileRange strip = work_.next(message.source).value_or(TileRange{});
      send(number, message.source, {Kind::strip, number, strip, 0, kStripBytes}, now);
    } else if (message.kind == Kind::strip) {
      rank.asked = false;
      give(rank, message.strip);
    } else {
      now += message.tiles * settings_.costs.tile_in;
    }
  }

  static void give(SimulatedRank& rank, const TileRange& strip) {
    if (strip.size() == 0) {
      rank.no_more = true;
    } else {
      rank.next = strip;
    }
  }

  void ask_in_time(int number, double& now) {
    SimulatedRank& rank = at(number);
    if (rank.asked || rank.next || rank.no_more || rank.current.size() > kBatchesAhead * rank.tiles_per_batch)
      return;
    if (number != 0) {
      rank.asked = true;
      send(number, 0, {Kind::ask, number, {}, 0, 0}, now);
    } else if (rank.current.size() == 0) {
      now += settings_.costs.decision;
      give(rank, work_.next(0).value_or(TileRange{}));
    }
  }

  void begin_batch(int number, double now) {
    SimulatedRank& rank = at(number);
    const TileRange batch{rank.current.first,
                          std::min(rank.current.last, rank.current.first + rank.tiles_per_batch)};
    rank.current.first = batch.last;
    rank.batch_size = batch.size();
    rank.batch = work_.compute(batch);
    const double seconds = rank.batch.seconds / settings_.speed[static_cast<std::size_t>(number)];
    times(number).busy += seconds;
    times(number).tiles += batch.size();
    if (seconds > 1.5 * kBatchSeconds) {
      rank.tiles_per_batch = std::max<std::uint64_t>(1, rank.tiles_per_batch / 2);
    } else if (seconds < kBatchSeconds / 1.5 && rank.batch_size == rank.tiles_per_batch) {
      rank.tiles_per_batch = std::min(kMaxTilesPerBatch, 2 * rank.tiles_per_batch);
    }
    push(now + seconds, EventKind::computed, number);
  }

  void deliver(int number, double start) {
    double now = start;
    for (const Delivery& delivery : at(number).batch.deliveries) {
      if (delivery.target == number) {
        now += delivery.tiles * settings_.costs.tile_in;
      } else {
        now += delivery.tiles * settings_.costs.tile_out;
        send(number, delivery.target, {Kind::tiles, number, {}, delivery.tiles, delivery.bytes}, now);
      }
    }
    continue_after_messages(number, start, now);
  }

  void arrive(int number, const SimulatedMessage& message, double time) {
    at(number).inbox.push_back(message);
    if (at(number).asleep) wake(number, time);
  }

  /// At the first look at or after `time`; looks grow rarer the longer a rank has slept.
  void wake(int number, double time) {
    SimulatedRank& rank = at(number);
    double look = settings_.sleeps ? rank.slept_since : time;
    while (settings_.sleeps && (look == rank.slept_since || look < time)) {
      const double waited = look - rank.slept_since;
      look += std::clamp(kPausePart * waited, kShortestPause, kLongestPause) + settings_.timer_slack;
    }
    rank.asleep = false;
    push(look, EventKind::step, number);
  }

  JobResult result() const {
    JobResult result{0, times_};
    for (const RankTimes& rank : times_) result.seconds = std::max(result.seconds, rank.end);
    // A barrier: messages up and down a tree.
    if (ranks() > 1)
      result.seconds += 2 * std::ceil(std::log2(ranks())) * settings_.network.between_hosts.latency;
    for (RankTimes& rank : result.ranks) rank.waiting = result.seconds - rank.busy - rank.messages;
    return result;
  }

  SimulatedWork& work_;
  const JobSettings& settings_;
  Traffic traffic_;
  std::vector<SimulatedRank> ranks_;
  std::vector<RankTimes> times_;
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
  std::uint64_t event_count_ = 0;
};

}  // namespace

RankTimes JobResult::total() const {
  RankTimes sum;
  for (const RankTimes& rank : ranks) {
    sum.busy += rank.busy;
    sum.messages += rank.messages;
    sum.waiting += rank.waiting;
    sum.strips += rank.strips;
    sum.tiles += rank.tiles;
    sum.messages_sent += rank.messages_sent;
    sum.bytes_sent += rank.bytes_sent;
    sum.end = std::max(sum.end, rank.end);
  }
  return sum;
}

double JobResult::idle_share() const {
  return total().waiting / (seconds * static_cast<double>(ranks.size()));
}

JobResult simulate_job(SimulatedWork& work, const JobSettings& settings) { return Job(work, settings).run(); }

}  // namespace fluxel::bench
