#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "visibility/cuda/tile_scene.hpp"

namespace fluxel::cuda::checks {

/// All tiles of the matrix's upper triangle, row after row.
[[nodiscard]] std::vector<TilePlace> upper_triangle(std::uint32_t tiles);

/// The numbers 0 to count - 1, so that the first ones, however many, lie spread over all.
[[nodiscard]] std::vector<std::size_t> spread_order(std::size_t count);

/// At most `wanted` tiles from all parts of the matrix.
[[nodiscard]] std::vector<TilePlace> spread_tiles(std::uint32_t tiles, std::size_t wanted);

/// f(k) for all k below `count`, by so many threads.
void in_parallel(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& f);

/// Of a pair of elements in a tile, by places in the tile.
[[nodiscard]] inline bool sees(const TileResult& result, std::uint32_t row, std::uint32_t column) {
  return (result.part[row][column / kGroup] >> column % kGroup & 1u) != 0;
}

}  // namespace fluxel::cuda::checks
