#include "mpi_master/steps/corrections_job.hpp"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <stdexcept>

#include "core/signals.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/row_parts.hpp"
#include "mpi_master/scheduling/tile_messages.hpp"
#include "mpi_master/steps/corrections_survey.hpp"

namespace fluxel {

namespace {

/// What is found, for the owner of its rows; a request for tiles; tiles, and the last of them.
enum CorrectionsTag : int { kFound = TileWork::kFirstTag, kWanted, kTiles, kLastTiles };

/// What is examined between two polls of the messages, and what one thread takes of it at a time [s].
constexpr double kBatchSeconds = 2e-3, kSliceSeconds = 2.5e-4;
constexpr std::size_t kMaxMessageBytes = std::size_t{4} << 20;

/// Examines tiles that have work. Those of a strip that this rank does not hold come from the owner of their
/// rows before the strip begins; what is found goes to the owners of both rows, with how many tiles are done,
/// so that an owner knows when it has all. An owner that is not complete still answers requests; one that is
/// complete gets none, because there is no tile of its rows left to examine.
class CorrectionsWork final : public TileWork {
 public:
  CorrectionsWork(const Workers& workers, const TileExaminer& examiner, const RowOwners& owners,
                  const TileStore& store, std::uint64_t expected, AvailableBytes available)
      : communicator_(workers.communicator),
        examiner_(examiner),
        owners_(owners),
        triangle_(owners.tile_rows()),
        store_(store),
        seconds_per_batch_(kBatchSeconds * workers.threads),
        expected_(expected),
        arena_(workers.threads),
        tiles_done_(static_cast<std::size_t>(communicator_.size())),
        entries_(std::move(available)) {}

  void prepare(const TileRange& strip) override {
    next_tiles_.reset();
    const std::size_t first_row = triangle_.row_of(strip.first), last_row = triangle_.row_of(strip.last - 1);
    for (int owner = owners_.owner(first_row); owner <= owners_.owner(last_row); ++owner) {
      if (!needs_tiles_of(owner, strip)) continue;
      if (!next_tiles_) next_tiles_.emplace(triangle_.side(), TileRows{first_row, last_row + 1});
      const auto bytes = std::as_bytes(std::span(&strip, 1));
      communicator_.send(owner, kWanted, Bytes(bytes.begin(), bytes.end()));
      ++answers_due_;
    }
  }

  [[nodiscard]] bool prepared() const override { return answers_due_ == 0; }

  void begin(const TileRange&) override { strip_tiles_ = std::move(next_tiles_); }

  std::uint64_t compute(const TileRange& batch) override {
    const std::uint64_t tiles = plan(batch);
    arena_.execute([&] {
      tbb::parallel_for(std::size_t{0}, slices_.size(), [&](std::size_t k) {
        const Slice& slice = slices_[k];
        TileBits bits;
        tiles_at(slice.row, slice.column).read(slice.row, slice.column, bits);
        examiner_.examine(slice.row, slice.column, bits, slice.first_line, slice.last_line, found_.local());
      });
    });
    return tiles;
  }

  void deliver() override {
    std::vector<std::vector<CorrectionEntry>> entries(tiles_done_.size());
    for (TileExaminer::Found& found : found_) {
      for (const CorrectionEntry& entry : found.entries)
        entries[static_cast<std::size_t>(owners_.owner(entry.row % examiner_.elements() / kTileSize))]
            .push_back(entry);
      found.entries.clear();
    }
    for (std::size_t target = 0; target < entries.size(); ++target) {
      const std::uint64_t tiles = std::exchange(tiles_done_[target], 0);
      if (static_cast<int>(target) == communicator_.rank()) {
        keep(tiles, entries[target]);
      } else if (tiles > 0 || !entries[target].empty()) {
        Bytes message(sizeof tiles + entries[target].size() * sizeof(CorrectionEntry));
        std::memcpy(message.data(), &tiles, sizeof tiles);
        std::ranges::copy(std::as_bytes(std::span(entries[target])), message.begin() + sizeof tiles);
        communicator_.send(static_cast<int>(target), kFound, std::move(message));
      }
    }
  }

  void take(const Message& message) override {
    if (message.tag == kFound) {
      take_found(message.data);
    } else if (message.tag == kWanted) {
      if (ended_) return;
      TileRange strip;
      std::memcpy(&strip, message.data.data(), sizeof strip);
      send_tiles(message.source, strip);
    } else {
      decode_tiles(message.data,
                   [this](std::size_t row, std::size_t column, TileTag tag, std::span<const std::byte> code) {
                     next_tiles_.value().put(row, column, tag, code);
                   });
      if (message.tag == kLastTiles) --answers_due_;
    }
  }

  [[nodiscard]] bool between_batches() override {
    has_room_ = entries_.has_room();
    return stop_requested() || !has_room_;
  }

  void end() override { ended_ = true; }

  [[nodiscard]] bool complete() const override { return received_ == expected_; }

  /// Collective, where all ranks have been stopped.
  [[noreturn]] void stop() {
    agree(communicator_, [this] {
      if (!has_room_)
        throw InputError(fmt::format(
            "not enough memory: rank {} has found {} corrections of form factors and has no room for more "
            "(use more hosts, a larger --form-factor-tolerance, or --form-factor disc)",
            communicator_.rank(), entries_.size()));
    });
    throw StopRequest("stopped by a signal while form factors were made");
  }

  /// Collective, at the end.
  FoundCorrections result(ScheduleRecord schedule) {
    CorrectionCounts counts;
    for (const TileExaminer::Found& found : found_) counts += found.counts;
    std::array<std::uint64_t, 4> sums{counts.near_pairs, counts.partial_pairs, counts.clipped_pairs,
                                      counts.rays};
    communicator_.all_sum(sums);
    return {
        entries_.compressed(examiner_.unknowns()), {sums[0], sums[1], sums[2], sums[3]}, std::move(schedule)};
  }

 private:
  /// Some lines of a tile.
  struct Slice {
    std::size_t row, column, first_line, last_line;
  };

  /// True where a strip has tiles that must come from this rank.
  [[nodiscard]] bool needs_tiles_of(int owner, const TileRange& strip) const {
    const TileRows& own = store_.owned();
    for (const RowPart& part : row_parts(triangle_, strip)) {
      if (owner == communicator_.rank() || owners_.owner(part.row) != owner) continue;
      for (std::size_t column = part.first; column < part.last; ++column)
        if (!own.contains(column) && examiner_.has_work(part.row, column)) return true;
    }
    return false;
  }

  /// Answers a request: what has work of a strip in rows that are owned here, but for columns that are the
  /// asker's.
  void send_tiles(int asker, const TileRange& strip) {
    Bytes message;
    for (const RowPart& part : row_parts(triangle_, strip)) {
      if (!store_.owned().contains(part.row)) continue;
      for (std::size_t column = part.first; column < part.last; ++column) {
        if (owners_.rows(asker).contains(column) || !examiner_.has_work(part.row, column)) continue;
        CodedTile tile{store_.tag(part.row, column), {}};
        if (tile.tag == TileTag::bits) {
          TileBits bits;
          store_.read(part.row, column, bits);
          tile.code = encode_tile(bits);
        }
        append_tiles(message, part.row, column, std::span(&tile, 1));
        if (message.size() > kMaxMessageBytes) communicator_.send(asker, kTiles, std::exchange(message, {}));
      }
    }
    communicator_.send(asker, kLastTiles, std::move(message));
  }

  /// The slices of the next tiles, until they are predicted to fill a batch; how many tiles that finishes. Of
  /// a tile that takes longer than a batch some lines are left for the next.
  std::uint64_t plan(const TileRange& batch) {
    slices_.clear();
    double seconds = 0;
    std::uint64_t tiles = 0;
    for (const RowPart& part : row_parts(triangle_, batch)) {
      for (std::size_t column = part.first; column < part.last; ++column) {
        if (seconds >= seconds_per_batch_) return tiles;
        seconds += kLookSeconds;
        if (examiner_.has_work(part.row, column)) {
          seconds += plan_tile(part.row, column, seconds_per_batch_ - seconds);
          if (lines_done_ < kTileSize) return tiles;
          lines_done_ = 0;
          count_as_done(part.row, column);
        }
        ++tiles;
      }
    }
    return tiles;
  }

  /// Lines of a tile for about `room` seconds, at least one; what they are predicted to take [s].
  double plan_tile(std::size_t row, std::size_t column, double room) {
    const double of_line =
        examiner_.predicted_seconds(row, column, tiles_at(row, column).tag(row, column)) / kTileSize;
    const auto lines = static_cast<std::size_t>(std::clamp<double>(kSliceSeconds / of_line, 1, kTileSize));
    const std::size_t before = lines_done_;
    do {
      slices_.push_back({row, column, lines_done_, std::min(lines_done_ + lines, kTileSize)});
      lines_done_ = slices_.back().last_line;
    } while (lines_done_ < kTileSize && static_cast<double>(lines_done_ - before) * of_line < room);
    return static_cast<double>(lines_done_ - before) * of_line;
  }

  void count_as_done(std::size_t row, std::size_t column) {
    const auto of_row = static_cast<std::size_t>(owners_.owner(row));
    const auto of_column = static_cast<std::size_t>(owners_.owner(column));
    ++tiles_done_[of_row];
    if (of_column != of_row) ++tiles_done_[of_column];
  }

  /// Where the bits of a tile of the current strip are.
  [[nodiscard]] const TileStore& tiles_at(std::size_t row, std::size_t column) const {
    const bool own = store_.owned().contains(row) || store_.owned().contains(column);
    return own ? store_ : strip_tiles_.value();
  }

  void take_found(const Bytes& message) {
    std::uint64_t tiles = 0;
    std::memcpy(&tiles, message.data(), sizeof tiles);
    std::vector<CorrectionEntry> entries((message.size() - sizeof tiles) / sizeof(CorrectionEntry));
    std::ranges::copy(std::span(message).subspan(sizeof tiles),
                      std::as_writable_bytes(std::span(entries)).begin());
    keep(tiles, entries);
  }

  void keep(std::uint64_t tiles, std::span<const CorrectionEntry> entries) {
    received_ += tiles;
    entries_.add(entries);
  }

  const Communicator& communicator_;
  const TileExaminer& examiner_;
  const RowOwners& owners_;
  TileTriangle triangle_;
  const TileStore& store_;
  double seconds_per_batch_;               // on one thread
  std::uint64_t expected_, received_ = 0;  // tiles that meet owned rows
  tbb::task_arena arena_;
  std::optional<TileStore> strip_tiles_, next_tiles_;  // not held here, of the current strip and the next
  int answers_due_ = 0;
  bool ended_ = false;
  std::vector<Slice> slices_;   // of the batch
  std::size_t lines_done_ = 0;  // of the tile that comes next
  tbb::enumerable_thread_specific<TileExaminer::Found> found_;
  std::vector<std::uint64_t> tiles_done_;  // by owner, not yet reported
  IncomingCorrections entries_;            // of owned rows
  bool has_room_ = true;                   // for more of them
};

}  // namespace

FoundCorrections find_corrections(const Workers& workers, const TileExaminer& examiner,
                                  const RowOwners& owners, const TileStore& store, AvailableBytes available) {
  const auto& [communicator, threads, progress] = workers;
  progress.begin("corrections");
  const CorrectionsSurvey own = survey_corrections(examiner, store, threads);
  // Ranks own rows in ascending order.
  const std::vector<double> seconds = communicator.all_gather(std::span<const double>(own.seconds));
  StripScheduler scheduler(owners, seconds, kMinStripSeconds * threads);
  if (!available) available = available_here(communicator);
  CorrectionsWork work(workers, examiner, owners, store, own.tiles, std::move(available));
  ScheduleRecord schedule = schedule_tiles(workers, scheduler, work);
  if (schedule.stopped) work.stop();
  FoundCorrections found = work.result(std::move(schedule));
  progress.end();
  return found;
}

}  // namespace fluxel
