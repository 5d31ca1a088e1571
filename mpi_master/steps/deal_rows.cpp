#include "mpi_master/steps/deal_rows.hpp"

#include <algorithm>
#include <utility>

#include "mpi_master/communication/machine.hpp"
#include "mpi_master/scheduling/tile_courier.hpp"

namespace fluxel {

namespace {

/// The work of the rank that has most, over what it was, from which on rows are dealt anew: to move all tiles
/// takes about as long as a twentieth of a product, and a solve has ten products or more.
constexpr double kWorthMoving = 0.98;

struct Row {
  double work;
  std::uint64_t bytes;  ///< in a store that holds this row alone
};

Row row_of(const TileStore& store, std::size_t row) {
  std::size_t mixed = 0, visible = 0, bytes = 0;
  for (std::size_t column = 0; column < store.tiles(); ++column) {
    const TileView tile = store.view(std::min(row, column), std::max(row, column));
    if (tile.tag == TileTag::visible) ++visible;
    if (tile.tag != TileTag::bits) continue;
    ++mixed;
    bytes += TileStore::pool_bytes(tile.code.size());
  }
  const auto tiles = static_cast<double>(store.tiles());
  return {row_work(static_cast<double>(mixed) / tiles, static_cast<double>(visible) / tiles),
          TileStore::bytes_for(store.tiles(), {row, row + 1}, bytes)};
}

double most_work(const RowOwners& owners, const std::vector<Row>& rows) {
  double most = 0;
  for (int rank = 0; rank < owners.ranks(); ++rank) {
    double work = 0;
    for (std::size_t row = owners.rows(rank).first; row < owners.rows(rank).last; ++row)
      work += rows[row].work;
    most = std::max(most, work);
  }
  return most;
}

/// Collective: whether each rank has memory for its rows.
bool fits(const Communicator& communicator, const TileRows& own, const std::vector<Row>& rows) {
  std::uint64_t bytes = 0;
  for (std::size_t row = own.first; row < own.last; ++row) bytes += rows[row].bytes;
  std::uint64_t fits_here = bytes <= available_here(communicator)() ? 1 : 0;
  communicator.all_min(std::span(&fits_here, 1));
  return fits_here > 0;
}

/// What this rank has and shall have.
void copy_kept(const TileStore& from, TileStore& to) {
  for (std::size_t row = to.owned().first; row < to.owned().last; ++row) {
    for (std::size_t column = 0; column < from.tiles(); ++column) {
      const std::size_t low = std::min(row, column), high = std::max(row, column);
      if (!from.owned().contains(low) && !from.owned().contains(high)) continue;
      if (to.has(low, high)) continue;
      const TileView tile = from.view(low, high);
      to.put(low, high, tile.tag, tile.code);
    }
  }
}

/// The owner of the lower row hands a tile to those who do not have it.
void send_moved(const Visibility& visibility, const RowOwners& dealt, TileCourier& courier) {
  const RowOwners& before = visibility.owners;
  const TileStore& from = visibility.store;
  for (std::size_t row = from.owned().first; row < from.owned().last; ++row) {
    for (std::size_t column = row; column < from.tiles(); ++column) {
      const auto has = [&](int rank) { return rank == before.owner(row) || rank == before.owner(column); };
      const int row_owner = dealt.owner(row), column_owner = dealt.owner(column);
      if (!has(row_owner)) courier.hand_over(row_owner, row, column, from.view(row, column));
      if (column_owner != row_owner && !has(column_owner))
        courier.hand_over(column_owner, row, column, from.view(row, column));
    }
  }
}

}  // namespace

void deal_rows(const Communicator& communicator, Visibility& visibility) {
  std::vector<Row> own;
  const TileRows& owned = visibility.store.owned();
  for (std::size_t row = owned.first; row < owned.last; ++row) own.push_back(row_of(visibility.store, row));
  const std::vector<Row> rows = communicator.all_gather(std::span<const Row>(own));
  std::vector<double> work(rows.size());
  std::ranges::transform(rows, work.begin(), &Row::work);
  const RowOwners dealt(work, communicator.size());
  if (most_work(dealt, rows) > kWorthMoving * most_work(visibility.owners, rows)) return;
  const TileRows mine = dealt.rows(communicator.rank());
  if (!fits(communicator, mine, rows)) return;

  TileStore store(visibility.store.tiles(), mine);
  TileCourier courier(communicator, store);
  send_moved(visibility, dealt, courier);
  courier.finish();
  copy_kept(visibility.store, store);
  visibility.store = std::move(store);
  visibility.owners = dealt;
}

}  // namespace fluxel
