#pragma once

#include <cstdint>
#include <vector>

#include "formfactor/tile_examiner.hpp"
#include "mpi_master/communication/communicator.hpp"
#include "visibility/tile_tracer.hpp"

namespace fluxel {

/// What tile rows cost, as far as a sample tells: the same on all ranks.
struct RowCosts {
  std::vector<double> trace;  ///< [s] of processor time of the row's tiles (row, column >= row)
  std::vector<double>
      solve;  ///< of the whole row: its share of the kernel's work, and a little for its bytes
  std::vector<double> bytes;        ///< of the code of a tile of the row, in the mean, either way round
  std::vector<double> corrections;  ///< entries of the row in a tile, in the mean; of an examiner alone

  /// Every tile costs the same: `seconds` to trace.
  [[nodiscard]] static RowCosts even(std::size_t tile_rows, double seconds);
};

/// What a product takes in a row of tiles, of which these shares have bits and are wholly visible: 1 where
/// all are visible.
[[nodiscard]] double row_work(double mixed, double visible);

/// Tiles traced before all others, for forecasts and even shares.
struct TileSample {
  std::uint64_t tiles = 0;
  std::uint64_t mixed = 0;  ///< of these, with bits
  RowCosts costs;
  double share_of_processor = 1;  ///< that threads got: less where there are more of them than processors
};

/// What a sample is for: to share out the work evenly, which takes some tiles of every row, or to know how
/// much there is, which takes a few thousand, whatever the number of rows.
enum class SampleUse { shares, totals };

/// Collective: traces tiles spread over the matrix by a fixed seed, each on one rank. The sample grows until
/// the mean bytes are known to a few per cent, or it would take a noticeable part of the work itself.
/// An `examiner` counts corrections of form factors in these tiles.
[[nodiscard]] TileSample sample_tiles(const Communicator& communicator, const TileTracer& tracer, int threads,
                                      SampleUse use = SampleUse::shares,
                                      const TileExaminer* examiner = nullptr);

}  // namespace fluxel
