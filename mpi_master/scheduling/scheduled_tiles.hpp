#pragma once

#include <vector>

#include "mpi_master/communication/workers.hpp"
#include "mpi_master/scheduling/activity.hpp"
#include "mpi_master/scheduling/strip_scheduler.hpp"

namespace fluxel {

/// What a rank does with the tiles that it is assigned, and with what other ranks send it meanwhile.
class TileWork {
 public:
  /// Tags of the work's own messages begin here.
  static constexpr int kFirstTag = 16;

  virtual ~TileWork() = default;

  /// A strip has been assigned and will begin when the one before it is done: what its tiles need may be
  /// asked of other ranks.
  virtual void prepare(const TileRange& /*strip*/) {}
  /// Whether the strip that has been assigned last has what it needs.
  [[nodiscard]] virtual bool prepared() const { return true; }
  /// A strip is about to be computed, batch after batch.
  virtual void begin(const TileRange& strip) = 0;
  /// Computes tiles from the first of a batch on; how many are done. The next batch begins with those that
  /// are not.
  virtual std::uint64_t compute(const TileRange& batch) = 0;
  /// About how long a batch shall take [s]: others wait that long for an answer, and the start and end of the
  /// threads' work are short beside it.
  [[nodiscard]] virtual double batch_seconds() const { return 2e-3; }
  /// Sends what the last batch gave.
  virtual void deliver() = 0;
  /// A message with a tag of the work.
  virtual void take(const Message& message) = 0;
  /// Between batches and while waiting: the place to save what there is. Whether all ranks shall stop.
  [[nodiscard]] virtual bool between_batches() { return false; }
  /// This rank has no part any more and sends nothing: what others ask for comes too late, as they stop too.
  virtual void end() {}
  /// Whether this rank has all that it shall have from others.
  [[nodiscard]] virtual bool complete() const = 0;
};

struct ScheduleRecord {
  std::vector<Activity> of_ranks;      ///< on all ranks
  std::vector<ActivitySpan> timeline;  ///< of this rank
  bool stopped = false;                ///< on a rank's wish, on all ranks; the work may be incomplete then
};

/// Collective: rank 0 schedules strips and computes between its answers. A rank asks for its next strip
/// shortly before it has done with one, so that it need not wait for rank 0 to come back from its own tiles.
/// Returns when every rank's work is complete, or when one of them wishes to stop; all messages have arrived
/// then. The scheduler of rank 0 is the one that decides.
[[nodiscard]] ScheduleRecord schedule_tiles(const Workers& workers, StripScheduler& scheduler,
                                            TileWork& work);

}  // namespace fluxel
