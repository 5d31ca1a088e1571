#include "mpi_master/checkpoint/restore_strips.hpp"

#include <fmt/format.h>

#include <fstream>
#include <span>
#include <string>

#include "mpi_master/communication/texts.hpp"
#include "mpi_master/scheduling/tile_courier.hpp"
#include "visibility/strip_file.hpp"

namespace fluxel {

namespace {

/// One rank's part. Files may overlap: those of jobs with other numbers of ranks.
class Restorer {
 public:
  Restorer(const Communicator& communicator, const RowOwners& owners, const StripFileKey& key,
           TileStore& store)
      : communicator_(communicator),
        owners_(owners),
        key_(key),
        triangle_(store.tiles()),
        courier_(communicator, store) {}

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
    courier_.finish();
    std::uint32_t all = 0;
    for (const std::uint32_t makers : communicator_.all_gather(std::span<const std::uint32_t>(&makers_, 1)))
      all |= makers;
    return all;
  }

 private:
  void hand_over(std::uint64_t number, const TileView& tile) {
    const std::size_t row = triangle_.row_of(number), column = triangle_.column_of(row, number);
    const int row_owner = owners_.owner(row), column_owner = owners_.owner(column);
    courier_.hand_over(row_owner, row, column, tile);
    if (column_owner != row_owner) courier_.hand_over(column_owner, row, column, tile);
  }

  const Communicator& communicator_;
  const RowOwners& owners_;
  const StripFileKey& key_;
  TileTriangle triangle_;
  TileCourier courier_;
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
