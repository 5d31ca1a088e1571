#include "mpi_master/steps/visibility_hash.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <span>
#include <vector>

#include "core/hash.hpp"
#include "visibility/tile.hpp"

namespace fluxel {

namespace {

/// Bits of places past the last element are none.
std::uint64_t hash_of_row(const TileStore& store, std::size_t row, std::size_t elements) {
  std::uint64_t hash = 0;
  for (std::size_t column = row; column < tile_count(elements); ++column) {
    TileBits bits;
    store.read(row, column, bits);
    const std::uint64_t valid = low_bits(rows_of_tile(column, elements));
    for (std::size_t r = 0; r < kTileSize; ++r)
      bits[r] = r < rows_of_tile(row, elements) ? bits[r] & valid : 0;
    hash = hash_bytes(std::as_bytes(std::span(bits)), hash);
  }
  return hash;
}

}  // namespace

std::uint64_t hash_of_visibility(const Communicator& communicator, const TileStore& store,
                                 std::size_t elements, int threads) {
  const TileRows& rows = store.owned();
  std::vector<std::uint64_t> row_hashes(rows.size());
  tbb::task_arena(threads).execute([&] {
    tbb::parallel_for(rows.first, rows.last, [&](std::size_t row) {
      row_hashes[row - rows.first] = hash_of_row(store, row, elements);
    });
  });
  const auto all = communicator.all_gather(std::span<const std::uint64_t>(row_hashes));
  return hash_bytes(std::as_bytes(std::span(all)));
}

}  // namespace fluxel
