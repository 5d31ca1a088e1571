#include "mpi_master/checkpoint/restore_strips.hpp"

#include <fmt/format.h>

#include <cstring>
#include <fstream>
#include <span>
#include <string>
#include <utility>

#include "mpi_master/communication/texts.hpp"
#include "mpi_master/scheduling/back_off.hpp"
#include "visibility/coded_tile.hpp"
#include "visibility/strip_file.hpp"

namespace fluxel {

namespace {

constexpr int kKeptTiles = 1;
constexpr std::size_t kMaxUnsent = std::size_t{4} << 20;  // [bytes], for all ranks together

/// One rank's part. A message: the number of a tile and the tile, again and again.
class Restorer {
 public:
  Restorer(const Communicator& communicator, const RowOwners& owners, const StripFileKey& key,
           TileStore& store)
      : communicator_(communicator),
        owners_(owners),
        key_(key),
        triangle_(store.tiles()),
        store_(store),
        unsent_(static_cast<std::size_t>(communicator.size())) {}

  /// What is wrong with the file, as a sentence; empty: nothing.
  std::string read(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return fmt::format("{} cannot be read", file.string());
    const StripFileResult result = read_strip_file(
        stream, key_, [this](std::uint64_t number, const TileView& tile) { hand_over(number, tile); });
    makers_ |= result.makers;
    if (result.defect.empty()) return {};
    return fmt::format("{} {}: {} tiles are taken from it", file.string(), result.defect, result.tiles);
  }

  /// Collective. Returns the makers of all that has been read.
  std::uint32_t finish() {
    send_all();
    communicator_.receive_all([this](const Message& message) { take(message); });
    std::uint32_t all = 0;
    for (const std::uint32_t makers : communicator_.all_gather(std::span<const std::uint32_t>(&makers_, 1)))
      all |= makers;
    return all;
  }

 private:
  void hand_over(std::uint64_t number, const TileView& tile) {
    const std::size_t row = triangle_.row_of(number), column = triangle_.column_of(row, number);
    const int row_owner = owners_.owner(row), column_owner = owners_.owner(column);
    hand_over_to(row_owner, number, tile);
    if (column_owner != row_owner) hand_over_to(column_owner, number, tile);
  }

  void hand_over_to(int target, std::uint64_t number, const TileView& tile) {
    if (target == communicator_.rank()) return put(number, tile);
    Bytes& message = unsent_[static_cast<std::size_t>(target)];
    const std::size_t before = message.size();
    const auto bytes = std::as_bytes(std::span(&number, 1));
    message.insert(message.end(), bytes.begin(), bytes.end());
    append_tile(message, tile);
    unsent_bytes_ += message.size() - before;
    if (unsent_bytes_ > kMaxUnsent) send_all();
  }

  void send_all() {
    for (int target = 0; target < communicator_.size(); ++target) {
      Bytes& message = unsent_[static_cast<std::size_t>(target)];
      if (!message.empty()) communicator_.send(target, kKeptTiles, std::exchange(message, {}));
    }
    unsent_bytes_ = 0;
    // What leaves slower than it is read would fill the memory.
    BackOff pause;
    while (communicator_.pending_sends() > kMaxPendingSends)
      if (const auto message = communicator_.receive()) {
        take(*message);
      } else {
        pause.wait();
      }
  }

  void take(const Message& message) {
    std::span<const std::byte> rest(message.data);
    while (!rest.empty()) {
      std::uint64_t number = 0;
      std::memcpy(&number, rest.data(), sizeof number);
      rest = rest.subspan(sizeof number);
      put(number, take_tile(rest));
    }
  }

  /// Files may overlap: those of jobs with other numbers of ranks.
  void put(std::uint64_t number, const TileView& tile) {
    const std::size_t row = triangle_.row_of(number), column = triangle_.column_of(row, number);
    if (!store_.has(row, column)) store_.put(row, column, tile.tag, tile.code);
  }

  const Communicator& communicator_;
  const RowOwners& owners_;
  const StripFileKey& key_;
  TileTriangle triangle_;
  TileStore& store_;
  std::vector<Bytes> unsent_;  // by rank
  std::size_t unsent_bytes_ = 0;
  std::uint32_t makers_ = 0;  // of the files read here
};

}  // namespace

std::vector<TileRange> restore_strips(const Communicator& communicator, const RowOwners& owners,
                                      Checkpoint& checkpoint, TileStore& store) {
  const auto& files = checkpoint.earlier();
  if (files.empty()) return {};
  Restorer restorer(communicator, owners, checkpoint.key(), store);
  std::vector<std::string> defects;
  for (auto k = static_cast<std::size_t>(communicator.rank()); k < files.size();
       k += static_cast<std::size_t>(communicator.size())) {
    const std::string defect = restorer.read(files[k]);
    if (!defect.empty()) defects.push_back(defect);
  }
  checkpoint.add_makers(restorer.finish());
  for (const std::string& defect : texts_of_all(communicator, defects)) checkpoint.warn(defect);
  const std::vector<TileRange> held = held_ranges(store);
  return communicator.all_gather(std::span<const TileRange>(held));
}

std::vector<TileRange> held_ranges(const TileStore& store) {
  const TileTriangle triangle(store.tiles());
  std::vector<TileRange> ranges;
  for (std::size_t row = store.owned().first; row < store.owned().last; ++row) {
    for (std::size_t column = row; column < store.tiles(); ++column) {
      if (!store.has(row, column)) continue;
      const std::uint64_t number = triangle.number(row, column);
      if (ranges.empty() || ranges.back().last != number) ranges.push_back({number, number});
      ++ranges.back().last;
    }
  }
  return ranges;
}

}  // namespace fluxel
