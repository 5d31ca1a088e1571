#include "mpi_master/steps/visibility_job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "core/signals.hpp"
#include "mpi_master/checkpoint/restore_strips.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/machine.hpp"
#include "mpi_master/communication/row_parts.hpp"
#include "mpi_master/scheduling/strip_scheduler.hpp"
#include "mpi_master/scheduling/tile_messages.hpp"
#include "mpi_master/steps/tile_batch.hpp"
#include "mpi_master/steps/visibility_hash.hpp"

namespace fluxel {

namespace {

enum VisibilityTag : int {
  kTracedTiles = TileWork::kFirstTag,
  kNotKept,  // why strips cannot be kept
  kDeviceFailed,
};

/// Collective: those of all ranks together.
std::uint32_t makers_of_all(const Communicator& communicator, std::uint32_t own) {
  std::uint32_t all = 0;
  for (const std::uint32_t makers : communicator.all_gather(std::span<const std::uint32_t>(&own, 1)))
    all |= makers;
  return all;
}

/// A batch of a GPU's [s]: several launches.
constexpr double kDeviceBatchSeconds = 8e-3;

/// Traces tiles; each goes to the owner of its row and to that of its column.
class VisibilityWork final : public TileWork {
 public:
  VisibilityWork(const Workers& workers, const TileTracer& tracer, const RowOwners& owners,
                 Checkpoint& checkpoint, DeviceTiles* device)
      : communicator_(workers.communicator),
        tracer_(tracer),
        owners_(owners),
        triangle_(owners.tile_rows()),
        store_(owners.tile_rows(), owners.rows(communicator_.rank())),
        batch_(tracer, workers.threads),
        checkpoint_(checkpoint),
        threads_(workers.threads),
        device_(device) {
    const auto places = rank_places(communicator_, threads_);
    ranks_on_host_ = places[static_cast<std::size_t>(communicator_.rank())].ranks_on_host;
  }

  /// Collective, before all else: takes what earlier jobs have kept, and returns the tiles of it.
  std::vector<TileRange> restore() {
    std::vector<TileRange> restored = restore_strips(communicator_, owners_, checkpoint_, store_);
    for (const TileRange& range : held_ranges(store_))
      for (const RowPart& part : row_parts(triangle_, range))
        for (std::size_t column = part.first; column < part.last; ++column)
          ++(store_.tag(part.row, column) == TileTag::bits ? kept_.mixed : kept_.uniform);
    // What stands in files of other numbers of ranks shall stand in those of this one, which replace them.
    if (checkpoint_.keeps() && !restored.empty()) warn_of_not_kept(checkpoint_.write_all(store_, true));
    return restored;
  }

  /// What schedules the tiles: it learns when a rank has lost its device.
  void scheduled_by(StripScheduler& scheduler) { scheduler_ = &scheduler; }

  [[nodiscard]] double batch_seconds() const override {
    return device_ == nullptr ? TileWork::batch_seconds() : kDeviceBatchSeconds;
  }

  bool between_batches() override {
    const bool asked = take_snapshot_request(), terminated = TerminationCatcher::take_termination();
    if (asked && !checkpoint_.keeps() && communicator_.is_root())
      checkpoint_.warn("SIGUSR1 asks for a checkpoint, but there is no --checkpoint");
    if (checkpoint_.keeps() && (asked || terminated || checkpoint_.is_due()) && !checkpoint_.write(store_))
      notify_root(kNotKept, checkpoint_.failure());
    return stop_requested();
  }

  void begin(const TileRange& strip) override { require_room(strip.size()); }

  std::uint64_t compute(const TileRange& batch) override {
    parts_ = row_parts(triangle_, batch);
    batch_.start(parts_);
    batch_.trace(device_ == nullptr ? 0 : trace_on_device());
    return batch.size();
  }

  /// Each part of a row goes whole to the owner of the row, and piece by piece to the owners of its columns;
  /// what goes to one rank goes in one message.
  void deliver() override {
    std::vector<Bytes> messages(static_cast<std::size_t>(communicator_.size()));
    for (const RowPart& part : parts_) {
      const int row_owner = owners_.owner(part.row);
      hand_over(row_owner, part, part.first, part.last, messages);
      for (std::size_t first = part.first; first < part.last;) {
        const int column_owner = owners_.owner(first);
        const std::size_t last = std::min(part.last, owners_.rows(column_owner).last);
        if (column_owner != row_owner) hand_over(column_owner, part, first, last, messages);
        first = last;
      }
    }
    for (std::size_t target = 0; target < messages.size(); ++target) {
      if (messages[target].empty()) continue;
      message_bytes_ += messages[target].size();
      communicator_.send(static_cast<int>(target), kTracedTiles, std::move(messages[target]));
    }
  }

  void take(const Message& message) override {
    if (message.tag == kNotKept || message.tag == kDeviceFailed)
      return handle_notice(message.source, message.tag,
                           {reinterpret_cast<const char*>(message.data.data()), message.data.size()});
    decode_tiles(message.data,
                 [this](std::size_t row, std::size_t column, TileTag tag, std::span<const std::byte> code) {
                   store_.put(row, column, tag, code);
                 });
  }

  [[nodiscard]] bool complete() const override { return store_.held() == store_.expected(); }

  /// Collective, after a signal: keeps what there is, then throws.
  [[noreturn]] void stop() {
    const std::string reason = checkpoint_.keeps() ? checkpoint_.write_all(store_, false) : std::string();
    std::uint64_t held = 0;
    for (const TileRange& range : held_ranges(store_)) held += range.size();
    communicator_.all_sum(std::span(&held, 1));
    if (!checkpoint_.keeps())
      throw StopRequest("stopped by a signal; nothing is kept, as there is no --checkpoint");
    if (!reason.empty())
      throw AgreedError(fmt::format("stopped by a signal, and not all finished strips are kept: {}", reason));
    throw StopRequest(
        fmt::format("stopped by a signal; {} of {} tiles of visibility stand in {}: go on with --resume",
                    held, triangle_.size(), checkpoint_.folder().string()));
  }

  /// This rank alone, when something has failed: keeps what it has, if that can still be done.
  void save() noexcept {
    try {
      if (checkpoint_.keeps()) checkpoint_.write(store_);
    } catch (...) {  // the first failure is the one to report
    }
  }

  /// Collective, at the end.
  Visibility result(ScheduleRecord schedule) {
    checkpoint_.add_makers(makers_of_all(communicator_, checkpoint_.makers()));
    const std::string not_kept = checkpoint_.keeps() ? checkpoint_.write_all(store_, true) : std::string();
    const TileBatchCounts& made = batch_.counts();
    std::array<std::uint64_t, 9> sums{made.rays,
                                      made.uniform + kept_.uniform,
                                      made.mixed + kept_.mixed,
                                      message_bytes_,
                                      store_.bytes(),
                                      kept_.uniform + kept_.mixed,
                                      device_counts_.tiles,
                                      device_counts_.verified_pairs,
                                      device_counts_.differing_bits};
    communicator_.all_sum(sums);
    const VisibilityCounts counts{
        sums[0], sums[1], sums[2], sums[3], sums[4], sums[5], {sums[6], sums[7], sums[8]}};
    const std::uint64_t hash = hash_of_visibility(communicator_, store_, tracer_.elements(), threads_);
    std::vector<DeviceFailure> failures = device_failures_of_all(communicator_, device_failure_);
    return {owners_,
            std::move(store_),
            counts,
            std::move(schedule),
            std::move(failures),
            checkpoint_.makers(),
            not_kept,
            hash};
  }

 private:
  void notify_root(int tag, const std::string& reason) {
    if (communicator_.is_root()) return handle_notice(0, tag, reason);
    const auto bytes = std::as_bytes(std::span(reason));
    communicator_.send(0, tag, Bytes(bytes.begin(), bytes.end()));
  }

  /// On the root: what a rank reports.
  void handle_notice(int rank, int tag, const std::string& reason) {
    if (tag == kNotKept) return warn_of_not_kept(reason);
    if (scheduler_ != nullptr) scheduler_->set_min_cost(rank, kMinStripSeconds * threads_);
  }

  /// On the root, of whatever rank; once, though all ranks may fail again and again.
  void warn_of_not_kept(const std::string& reason) {
    if (reason.empty() || std::exchange(warned_, true)) return;
    checkpoint_.warn(fmt::format("finished strips cannot be kept, and the run goes on: {}", reason));
  }

  /// Throws where a strip's tiles are not to be had: then rather a message now than a kill later. The system
  /// is asked again only when the strips since may have taken what it had.
  void require_room(std::uint64_t tiles) {
    const std::size_t most = TileStore::max_bytes(tiles);
    if (most > room_) {
      room_ = available_bytes(ranks_on_host_);
      const TileBatchCounts& counts = batch_.counts();
      const std::uint64_t made = counts.mixed + counts.uniform;
      const std::uint64_t likely = made == 0 ? 0 : tiles * counts.code_bytes / made;
      if (likely > room_)
        throw std::runtime_error(
            fmt::format("not enough memory: {} more tiles of visibility need about {} "
                        "bytes, and {} are to be had (use more hosts)",
                        tiles, likely, room_));
    }
    room_ -= std::min<std::uint64_t>(most, room_);
  }

  /// Returns how many of the batch's tiles the device has made: all, or those before it has failed.
  std::size_t trace_on_device() {
    std::size_t made = 0;
    try {
      device_->trace(batch_.places(), [&](std::size_t first, std::size_t count, const auto& tile) {
        batch_.code(first, count, tile);
        made = first + count;
      });
      device_counts_ = device_->counts();
    } catch (const cuda::DeviceError& error) {
      if (device_->is_required())
        throw InputError(fmt::format("{} (--device auto goes on without)", error.what()));
      device_counts_ = device_->counts();
      device_ = nullptr;
      checkpoint_.add_makers(kMadeByProcessor);
      device_failure_ = error.what();
      notify_root(kDeviceFailed, {});
    }
    return made;
  }

  /// The columns [first, last) of a part, into the store or the target's message.
  void hand_over(int target, const RowPart& part, std::size_t first, std::size_t last,
                 std::vector<Bytes>& messages) {
    const auto tiles = batch_.tiles().subspan(part.batch_first + (first - part.first), last - first);
    if (target != communicator_.rank()) {
      append_tiles(messages[static_cast<std::size_t>(target)], part.row, first, tiles);
      return;
    }
    for (std::size_t k = 0; k < tiles.size(); ++k)
      store_.put(part.row, first + k, tiles[k].tag, tiles[k].code.view());
  }

  const Communicator& communicator_;
  const TileTracer& tracer_;
  const RowOwners& owners_;
  TileTriangle triangle_;
  TileStore store_;
  TileBatch batch_;
  Checkpoint& checkpoint_;
  int threads_;
  StripScheduler* scheduler_ = nullptr;
  DeviceTiles* device_;  // null: none, or it has failed
  DeviceCounts device_counts_;
  std::string device_failure_;
  bool warned_ = false;  // that strips are not kept
  struct {
    std::uint64_t uniform = 0, mixed = 0;
  } kept_;  // tiles of own rows, column >= row, that an earlier job has kept
  std::uint64_t message_bytes_ = 0;
  std::vector<RowPart> parts_;  // of the batch
  int ranks_on_host_ = 1;
  std::uint64_t room_ = 0;  // [bytes] of memory, known to be left
};

}  // namespace

Visibility compute_visibility(const Workers& workers, const TileTracer& tracer, const RowCosts& costs,
                              Checkpoint& checkpoint, DeviceTiles* device) {
  const Communicator& communicator = workers.communicator;
  workers.progress.begin("visibility");
  const RowOwners owners(costs.solve, communicator.size());
  VisibilityWork work(workers, tracer, owners, checkpoint, device);
  std::optional<TerminationCatcher> catcher;
  if (checkpoint.keeps()) catcher.emplace();
  const std::vector<TileRange> done = work.restore();
  std::uint64_t left = TileTriangle(owners.tile_rows()).size();
  for (const TileRange& range : done) left -= range.size();
  const std::uint32_t maker = device == nullptr ? kMadeByProcessor : kMadeByGpu;
  checkpoint.add_makers(makers_of_all(communicator, left == 0 ? 0 : maker));
  const double speed = device == nullptr ? workers.threads : device->speed(costs);
  std::vector<double> min_costs = communicator.all_gather(std::span(&speed, 1));
  for (double& cost : min_costs) cost *= kMinStripSeconds;
  ScheduleRecord schedule;
  try {
    StripScheduler scheduler(owners, costs.trace, std::move(min_costs), done);
    work.scheduled_by(scheduler);
    schedule = schedule_tiles(workers, scheduler, work);
  } catch (...) {
    work.save();
    throw;
  }
  if (schedule.stopped) work.stop();
  Visibility result = work.result(std::move(schedule));
  workers.progress.end();
  return result;
}

Visibility compute_visibility(const Workers& workers, const TileTracer& tracer, const RowCosts& costs) {
  Checkpoint none;
  return compute_visibility(workers, tracer, costs, none, nullptr);
}

}  // namespace fluxel
