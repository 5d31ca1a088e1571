#include "mpi_master/visibility_job.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <thread>

#include "core/hash.hpp"
#include "mpi_master/machine.hpp"
#include "mpi_master/row_parts.hpp"
#include "mpi_master/strip_scheduler.hpp"
#include "mpi_master/tile_messages.hpp"

namespace fluxel {

namespace {

enum Tag : int { kAsk = 1, kStrip = 2, kTiles = 3 };

/// Between two looks at the messages [s]: others wait that long for an answer, and the start and end of the
/// threads' work are short beside it.
constexpr double kBatchSeconds = 2e-3;
constexpr std::size_t kMostTilesPerBatch = 4096;  // 2 MB of codes
constexpr std::size_t kMostPendingSends = 64;

/// One rank's part in the job. Messages: a rank asks rank 0, which answers with a strip (an empty one: no
/// more); tiles go to their owners. A rank asks for its next strip when it begins one, so that it never waits
/// for rank 0 to come back from its own tiles.
class VisibilityWorker {
 public:
  VisibilityWorker(const Communicator& communicator, const TileTracer& tracer, int threads,
                   Progress& progress)
      : communicator_(communicator),
        tracer_(tracer),
        threads_(static_cast<std::size_t>(threads)),
        tiles_per_batch_(64 * threads_),
        tiles_(tile_count(tracer.elements())),
        progress_(progress),
        scheduler_(tiles_, communicator.size()),
        store_(tiles_, owned_rows(tiles_, communicator.size(), communicator.rank())),
        arena_(threads) {
    const auto places = rank_places(communicator, threads);
    ranks_on_host_ = places[static_cast<std::size_t>(communicator.rank())].ranks_on_host;
  }

  Visibility run() {
    ask();
    while (!finished()) {
      handle_messages();
      if (current_.done() && next_ && next_->size() > 0) {
        require_room(*next_);
        current_ = StripWalk(*next_, tiles_);
        next_.reset();
        ask();
      }
      if (!current_.done()) {
        compute_batch();
        idle_ = std::chrono::microseconds(0);
      } else {
        wait_a_little();
      }
    }
    communicator_.barrier();
    return summary();
  }

 private:
  void ask() {
    if (communicator_.is_root()) {
      next_ = scheduler_.next(0).value_or(TileRows{});
    } else {
      communicator_.send(0, kAsk, {});
    }
  }

  void answer(int rank) {
    const TileRows strip = scheduler_.next(rank).value_or(TileRows{});
    if (strip.size() == 0) ++dismissed_;
    const auto bytes = std::as_bytes(std::span(&strip, 1));
    communicator_.send(rank, kStrip, Bytes(bytes.begin(), bytes.end()));
  }

  void handle_messages() {
    while (const auto message = communicator_.receive()) {
      idle_ = std::chrono::microseconds(0);
      if (message->tag == kAsk) {
        answer(message->source);
      } else if (message->tag == kStrip) {
        TileRows strip;
        std::memcpy(&strip, message->data.data(), sizeof strip);
        next_ = strip;
      } else {
        decode_tiles(message->data,
                     [this](std::size_t row, std::size_t column, TileTag tag,
                            std::span<const std::byte> code) { store_.put(row, column, tag, code); });
      }
    }
  }

  /// Throws where a strip's tiles are not to be had: then rather a message now than a kill later. The system
  /// is asked again only when the strips since may have taken what it had.
  void require_room(const TileRows& strip) {
    std::size_t tiles = 0;
    for (std::size_t row = strip.first; row < strip.last; ++row) tiles += tiles_ - row;
    const std::size_t most = TileStore::most_bytes(tiles);
    if (most > room_) {
      room_ = available_bytes(ranks_on_host_);
      const std::uint64_t made = counts_.tiles_mixed + counts_.tiles_uniform;
      const std::uint64_t likely = made == 0 ? 0 : tiles * code_bytes_ / made;
      if (likely > room_)
        throw std::runtime_error(
            fmt::format("not enough memory: {} more tiles of visibility need about {} "
                        "bytes, and {} are to be had (use more hosts)",
                        tiles, likely, room_));
    }
    room_ -= std::min<std::uint64_t>(most, room_);
  }

  /// Some tiles of the current strip, then they are sent off.
  void compute_batch() {
    const std::vector<RowPart> parts = current_.next(tiles_per_batch_);
    const auto start = std::chrono::steady_clock::now();
    trace(parts);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    // Tiles of one strip cost up to a hundred times those of another.
    if (seconds > 1.5 * kBatchSeconds) {
      tiles_per_batch_ = std::max(threads_, tiles_per_batch_ / 2);
    } else if (seconds < kBatchSeconds / 1.5) {
      tiles_per_batch_ = std::min(kMostTilesPerBatch, 2 * tiles_per_batch_);
    }
    deliver(parts);
    report_progress();
  }

  void trace(std::span<const RowPart> parts) {
    const std::size_t count = parts.back().batch_last();
    batch_.resize(count);
    std::atomic<std::uint64_t> rays = 0, mixed = 0, code_bytes = 0;
    arena_.execute([&] {
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), [&](const auto& range) {
        auto part = std::ranges::upper_bound(parts, range.begin(), {}, &RowPart::batch_first) - 1;
        std::uint64_t own_rays = 0, own_mixed = 0, own_bytes = 0;
        for (std::size_t k = range.begin(); k < range.end(); ++k) {
          if (k == part->batch_last()) ++part;
          const std::size_t column = part->first + (k - part->batch_first);
          const TracedTile tile = tracer_.trace(part->row, column);
          batch_[k].tag = tile.tag;
          if (tile.tag == TileTag::bits) {
            batch_[k].code = encode_tile(tile.bits);
            ++own_mixed;
            own_bytes += TileStore::pool_bytes(batch_[k].code.size);
          }
          own_rays += tile.rays;
        }
        rays += own_rays;
        mixed += own_mixed;
        code_bytes += own_bytes;
      });
    });
    counts_.rays += rays;
    counts_.tiles_mixed += mixed;
    counts_.tiles_uniform += count - mixed;
    code_bytes_ += code_bytes;
  }

  /// Each part of a row goes whole to the owner of the row, and piece by piece to the owners of its columns;
  /// what goes to one rank goes in one message.
  void deliver(std::span<const RowPart> parts) {
    std::vector<Bytes> messages(static_cast<std::size_t>(communicator_.size()));
    for (const RowPart& part : parts) {
      const int row_owner = owner(part.row);
      hand_over(row_owner, part, part.first, part.last, messages);
      for (std::size_t first = part.first; first < part.last;) {
        const int column_owner = owner(first);
        const std::size_t last =
            std::min(part.last, owned_rows(tiles_, communicator_.size(), column_owner).last);
        if (column_owner != row_owner) hand_over(column_owner, part, first, last, messages);
        first = last;
      }
    }
    for (std::size_t target = 0; target < messages.size(); ++target) {
      if (messages[target].empty()) continue;
      counts_.message_bytes += messages[target].size();
      communicator_.send(static_cast<int>(target), kTiles, std::move(messages[target]));
    }
    // Tiles that leave slower than they are made would fill the memory.
    while (communicator_.pending_sends() > kMostPendingSends) handle_messages();
  }

  /// The columns [first, last) of a part, into the store or the target's message.
  void hand_over(int target, const RowPart& part, std::size_t first, std::size_t last,
                 std::vector<Bytes>& messages) {
    const auto tiles =
        std::span<const CodedTile>(batch_).subspan(part.batch_first + (first - part.first), last - first);
    if (target != communicator_.rank()) {
      append_tiles(messages[static_cast<std::size_t>(target)], part.row, first, tiles);
      return;
    }
    for (std::size_t k = 0; k < tiles.size(); ++k)
      store_.put(part.row, first + k, tiles[k].tag, tiles[k].code.view());
  }

  [[nodiscard]] int owner(std::size_t row) const { return owner_of(tiles_, communicator_.size(), row); }

  [[nodiscard]] bool finished() {
    const bool no_more = next_ && next_->size() == 0 && current_.done();
    const bool all_told = !communicator_.is_root() || dismissed_ == communicator_.size() - 1;
    return no_more && all_told && store_.held() == store_.expected() && communicator_.pending_sends() == 0;
  }

  /// Sleeps longer the longer nothing comes, so that waiting costs no processor time.
  void wait_a_little() {
    idle_ = std::clamp(2 * idle_, std::chrono::microseconds(20), std::chrono::microseconds(1000));
    std::this_thread::sleep_for(idle_);
  }

  void report_progress() {
    const auto dealt = static_cast<double>(scheduler_.tiles_dealt());
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    constexpr double kPairsPerTile = kTileSize * kTileSize;
    progress_.update(dealt, static_cast<double>(scheduler_.tiles_in_all()),
                     fmt::format("{:.0f} million pairs/s", dealt * kPairsPerTile / seconds * 1e-6));
  }

  Visibility summary() {
    counts_.store_bytes = store_.bytes();
    std::array<std::uint64_t, 5> sums{counts_.rays, counts_.tiles_uniform, counts_.tiles_mixed,
                                      counts_.message_bytes, counts_.store_bytes};
    communicator_.all_sum(sums);
    counts_ = {sums[0], sums[1], sums[2], sums[3], sums[4]};
    const std::uint64_t hash = logical_hash();
    return {std::move(store_), counts_, hash};
  }

  /// A hash for each tile row, its tiles ascending from the diagonal, then of all of these.
  [[nodiscard]] std::uint64_t logical_hash() {
    const TileRows& rows = store_.owned();
    std::vector<std::uint64_t> row_hashes(rows.size());
    arena_.execute([&] {
      tbb::parallel_for(rows.first, rows.last,
                        [&](std::size_t row) { row_hashes[row - rows.first] = row_hash(row); });
    });
    const auto all = communicator_.all_gather(std::span<const std::uint64_t>(row_hashes));
    return hash_bytes(std::as_bytes(std::span(all)));
  }

  [[nodiscard]] std::uint64_t row_hash(std::size_t row) const {
    std::uint64_t hash = 0;
    for (std::size_t column = row; column < tiles_; ++column) {
      TileBits bits;
      store_.read(row, column, bits);
      const std::uint64_t valid = low_bits(rows_of_tile(column, tracer_.elements()));
      for (std::size_t r = 0; r < kTileSize; ++r)
        bits[r] = r < rows_of_tile(row, tracer_.elements()) ? bits[r] & valid : 0;
      hash = hash_bytes(std::as_bytes(std::span(bits)), hash);
    }
    return hash;
  }

  const Communicator& communicator_;
  const TileTracer& tracer_;
  std::size_t threads_;
  std::size_t tiles_per_batch_;
  std::size_t tiles_;
  Progress& progress_;
  StripScheduler scheduler_;  // rank 0's is the one that decides
  TileStore store_;
  tbb::task_arena arena_;
  VisibilityCounts counts_;
  std::uint64_t code_bytes_ = 0;  // of the tiles traced here
  std::vector<CodedTile> batch_;
  std::optional<TileRows> next_;  // an empty strip: there is no more
  StripWalk current_;
  int dismissed_ = 0;
  int ranks_on_host_ = 1;
  std::uint64_t room_ = 0;  // [bytes] of memory, known to be left
  std::chrono::microseconds idle_{0};
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

Visibility compute_visibility(const Communicator& communicator, const TileTracer& tracer, int threads,
                              Progress& progress) {
  progress.begin("visibility");
  Visibility result = VisibilityWorker(communicator, tracer, threads, progress).run();
  progress.end();
  return result;
}

}  // namespace fluxel
