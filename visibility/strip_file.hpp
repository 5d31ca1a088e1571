#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "visibility/coded_tile.hpp"
#include "visibility/tile_range.hpp"

namespace fluxel {

/// What a file of finished tiles belongs to: its bits are of use where all of this is the same.
struct StripFileKey {
  std::uint64_t identity = 0;  ///< visibility_identity
  std::uint64_t elements = 0;

  bool operator==(const StripFileKey&) const = default;
};

/// Who had a part in the tiles of a file: a mask.
enum StripMaker : std::uint32_t { kMadeByProcessor = 1, kMadeByGpu = 2 };

/// Writes finished tiles, by their numbers in a TileTriangle: a header, then segments of consecutive tiles,
/// each with its own check sum, so that a damaged byte loses one segment. Holds one segment in memory.
/// docs/file-formats.md has the format.
class StripFileWriter {
 public:
  /// Writes the header; `makers` is of StripMaker. The stream must outlive this; its state tells whether
  /// writing has succeeded.
  StripFileWriter(std::ostream& stream, const StripFileKey& key, std::uint32_t makers);

  /// Numbers ascend; a gap begins a new segment.
  void add(std::uint64_t number, const TileView& tile);

  /// Writes what is left and the end; nothing may be added afterwards.
  void finish();

 private:
  void write_segment();

  std::ostream& stream_;
  StripFileKey key_;
  TileRange range_;
  std::uint64_t tiles_ = 0;  // in all
  std::vector<std::byte> payload_;
};

/// What reading a file of strips came to.
struct StripFileResult {
  std::uint64_t tiles = 0;   ///< taken
  std::uint32_t makers = 0;  ///< of StripMaker; of a damaged header all
  std::string defect;        ///< what is wrong with the file, as the end of a sentence; empty: nothing
};

/// Reads a file of strips, from wherever it comes, and calls `take(number, tile)` for each tile of every
/// intact segment; tiles have valid codes and numbers of the key's matrix. Tiles of a file that belongs to
/// another key, or is of another version, are not taken. Holds one segment in memory; throws nothing but what
/// `take` and memory do.
[[nodiscard]] StripFileResult read_strip_file(
    std::istream& stream, const StripFileKey& key,
    const std::function<void(std::uint64_t, const TileView&)>& take);

}  // namespace fluxel
