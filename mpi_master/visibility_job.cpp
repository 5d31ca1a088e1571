#include "mpi_master/visibility_job.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <thread>

#include "core/hash.hpp"
#include "mpi_master/strip_scheduler.hpp"
#include "mpi_master/tile_messages.hpp"
#include "visibility/trace_tile.hpp"

namespace fluxel {

namespace {

enum Tag : int { kAsk = 1, kStrip = 2, kTiles = 3 };

constexpr std::size_t kTilesPerBatch = 64;  // for each thread, between two looks at the messages
constexpr std::size_t kMostPendingSends = 64;

/// One rank's part in the job. Messages: a rank asks rank 0, which answers with a strip (an empty one: no
/// more); tiles go to their owners. A rank asks for its next strip when it begins one, so that it never waits
/// for rank 0 to come back from its own tiles.
class VisibilityWorker {
 public:
  VisibilityWorker(const Communicator& communicator, const RayScene& ray_scene,
                   std::span<const Element> elements, int threads, Progress& progress)
      : communicator_(communicator),
        ray_scene_(ray_scene),
        elements_(elements),
        threads_(static_cast<std::size_t>(threads)),
        tiles_(tile_count(elements.size())),
        progress_(progress),
        scheduler_(tiles_, communicator.size()),
        store_(tiles_, owned_rows(tiles_, communicator.size(), communicator.rank())),
        arena_(threads) {}

  Visibility run() {
    ask();
    while (!finished()) {
      handle_messages();
      if (current_.size() == 0 && next_ && next_->size() > 0) {
        current_ = *next_;
        next_.reset();
        column_ = current_.first;
        ask();
      }
      if (current_.size() > 0) {
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
        decode_tiles(message->data, [this](std::size_t row, std::size_t column, TileTag tag,
                                           const TileBits& bits) { store_.put(row, column, tag, bits); });
      }
    }
  }

  /// Some tiles of the current strip's first row, then they are sent off.
  void compute_batch() {
    const std::size_t row = current_.first;
    const std::size_t count = std::min(tiles_ - column_, kTilesPerBatch * threads_);
    batch_.resize(count);
    arena_.execute([&] {
      tbb::parallel_for(std::size_t{0}, count, [&](std::size_t k) {
        batch_[k] = trace_tile(ray_scene_, elements_, row, column_ + k);
      });
    });
    for (const TracedTile& tile : batch_) {
      counts_.rays += tile.rays;
      ++(tile.tag == TileTag::bits ? counts_.tiles_mixed : counts_.tiles_uniform);
    }
    deliver(row);
    column_ += count;
    if (column_ == tiles_) {
      ++current_.first;
      column_ = current_.first;
    }
    report_progress();
  }

  /// The batch goes whole to the owner of its row, and in parts to the owners of its columns.
  void deliver(std::size_t row) {
    const int row_owner = owner(row);
    send_part(row_owner, row, 0, batch_.size());
    for (std::size_t first = 0; first < batch_.size();) {
      const int column_owner = owner(column_ + first);
      const std::size_t rows_end = owned_rows(tiles_, communicator_.size(), column_owner).last;
      const std::size_t last = std::min(batch_.size(), rows_end - column_);
      if (column_owner != row_owner) send_part(column_owner, row, first, last);
      first = last;
    }
    // Tiles that leave slower than they are made would fill the memory.
    while (communicator_.pending_sends() > kMostPendingSends) handle_messages();
  }

  void send_part(int target, std::size_t row, std::size_t first, std::size_t last) {
    const auto part = std::span<const TracedTile>(batch_).subspan(first, last - first);
    if (target == communicator_.rank()) {
      for (std::size_t k = 0; k < part.size(); ++k)
        store_.put(row, column_ + first + k, part[k].tag, part[k].bits);
      return;
    }
    Bytes message = encode_tiles(row, column_ + first, part);
    counts_.message_bytes += message.size();
    communicator_.send(target, kTiles, std::move(message));
  }

  [[nodiscard]] int owner(std::size_t row) const { return owner_of(tiles_, communicator_.size(), row); }

  [[nodiscard]] bool finished() {
    const bool no_more = next_ && next_->size() == 0 && current_.size() == 0;
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

  [[nodiscard]] std::uint64_t logical_hash() const {
    std::vector<std::uint64_t> row_hashes;
    for (std::size_t row = store_.owned().first; row < store_.owned().last; ++row) {
      std::uint64_t hash = 0;
      for (std::size_t column = row; column < tiles_; ++column) {
        TileBits bits;
        store_.read(row, column, bits);
        const std::uint64_t valid = low_bits(rows_of_tile(column, elements_.size()));
        for (std::size_t r = 0; r < kTileSize; ++r)
          bits[r] = r < rows_of_tile(row, elements_.size()) ? bits[r] & valid : 0;
        hash = hash_bytes(std::as_bytes(std::span(bits)), hash);
      }
      row_hashes.push_back(hash);
    }
    const auto all = communicator_.all_gather(std::span<const std::uint64_t>(row_hashes));
    return hash_bytes(std::as_bytes(std::span(all)));
  }

  const Communicator& communicator_;
  const RayScene& ray_scene_;
  std::span<const Element> elements_;
  std::size_t threads_;
  std::size_t tiles_;
  Progress& progress_;
  StripScheduler scheduler_;  // rank 0's is the one that decides
  TileStore store_;
  tbb::task_arena arena_;
  VisibilityCounts counts_;
  std::vector<TracedTile> batch_;
  std::optional<TileRows> next_;  // an empty strip: there is no more
  TileRows current_;
  std::size_t column_ = 0;
  int dismissed_ = 0;
  std::chrono::microseconds idle_{0};
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

Visibility compute_visibility(const Communicator& communicator, const RayScene& ray_scene,
                              std::span<const Element> elements, int threads, Progress& progress) {
  progress.begin("visibility");
  Visibility result = VisibilityWorker(communicator, ray_scene, elements, threads, progress).run();
  progress.end();
  return result;
}

}  // namespace fluxel
