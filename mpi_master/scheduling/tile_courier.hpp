#pragma once

#include <cstdint>
#include <vector>

#include "mpi_master/communication/communicator.hpp"
#include "visibility/coded_tile.hpp"
#include "visibility/tile_range.hpp"
#include "visibility/tile_store.hpp"

namespace fluxel {

/// Carries tiles that are somewhere into the stores of ranks that shall have them. No other message may be
/// under way meanwhile.
class TileCourier {
 public:
  /// Into `store` comes what is for this rank; both must outlive this.
  TileCourier(const Communicator& communicator, TileStore& store);

  /// Tile (row, column >= row), which belongs to the target's rows or columns; a tile that is there already
  /// is dropped.
  void hand_over(int target, std::size_t row, std::size_t column, const TileView& tile);

  /// Collective: when it returns, all has arrived.
  void finish();

 private:
  void send_all();
  void take(const Message& message);
  void put(std::uint64_t number, const TileView& tile);

  const Communicator& communicator_;
  TileStore& store_;
  TileTriangle triangle_;
  std::vector<Bytes> unsent_;  // by rank; the number of a tile and the tile, again and again
  std::size_t unsent_bytes_ = 0;
};

}  // namespace fluxel
