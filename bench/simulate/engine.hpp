#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "bench/simulate/network.hpp"
#include "visibility/tile_range.hpp"

namespace fluxel::bench {

/// What a rank gets of a batch.
struct Delivery {
  int target = 0;
  double tiles = 0;
  double bytes = 0;
};

/// What a batch of tiles takes and gives.
struct Batch {
  double seconds = 0;                ///< of a rank of speed 1
  std::vector<Delivery> deliveries;  ///< also to the rank that computes, which is no message
};

/// The work that is handed out in a simulated job.
class SimulatedWork {
 public:
  virtual ~SimulatedWork() = default;
  /// What a rank that asks gets; nothing when all is assigned.
  [[nodiscard]] virtual std::optional<TileRange> next(int rank) = 0;
  [[nodiscard]] virtual Batch compute(const TileRange& tiles) = 0;
};

/// Processor time of a rank's exchanges with others [s].
struct MessageCosts {
  double send = 0, receive = 0;      ///< of a message, whatever is in it
  double tile_out = 0, tile_in = 0;  ///< of a tile: into a message, out of it into the store
  double decision = 0;               ///< of the scheduler
};

struct JobSettings {
  Network network;
  MessageCosts costs;
  bool sleeps = true;         ///< waiting ranks do, instead of looking all the time as MPI's own waits do
  double timer_slack = 0;     ///< by which a sleep is longer than asked for [s]
  std::vector<double> speed;  ///< of each rank; its size is the number of ranks
};

struct RankTimes {
  double busy = 0, messages = 0, waiting = 0;  ///< [s]; their sum is the same for all ranks
  double end = 0;                              ///< of its last own activity [s]
  std::uint64_t strips = 0, tiles = 0;
  std::uint64_t messages_sent = 0;
  double bytes_sent = 0;
};

struct JobResult {
  double seconds = 0;  ///< until all ranks have met
  std::vector<RankTimes> ranks;

  [[nodiscard]] RankTimes total() const;
  /// Waiting, of all ranks' time.
  [[nodiscard]] double idle_share() const;
};

/// Plays a job of mpi_master/scheduling/scheduled_tiles event by event: ranks ask ahead, compute batches,
/// deliver, look at their messages between batches, sleep while there is nothing to do. Rank 0 also answers.
[[nodiscard]] JobResult simulate_job(SimulatedWork& work, const JobSettings& settings);

}  // namespace fluxel::bench
