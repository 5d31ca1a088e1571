#include "solver/cuda/row_matrix.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "visibility/cuda/device.hpp"

namespace fluxel::cuda {

namespace {

constexpr std::size_t kTileBytes = kTile * sizeof(std::uint64_t);
constexpr std::size_t kMaxChannels = 3;
constexpr std::uint32_t kSlicesAtOnce = 1u << 15;

}  // namespace

RowMatrix::RowMatrix(const RowShape& shape, const float* columns, const SummaryOf& summary_of,
                     ReadBits read_bits)
    : shape_(shape), columns_(columns), read_bits_(std::move(read_bits)) {
  entries_.reserve(std::size_t{rows()} * shape.tiles);
  std::size_t with_bits = 0;
  for (std::uint32_t row = shape.first_row; row < shape.last_row; ++row) {
    first_bits_.push_back(with_bits);
    for (std::uint32_t column = 0; column < shape.tiles; ++column) {
      const TileSummary summary = summary_of(std::min(row, column), std::max(row, column));
      std::uint32_t seen = summary.seen == TileSummary::Seen::all ? TileEntry::kAll : TileEntry::kNothing;
      if (summary.seen == TileSummary::Seen::some) {
        if (!is_kept_with(row, column)) {
          seen = entries_[std::size_t{column - shape.first_row} * shape.tiles + row].seen();
        } else if (with_bits < (std::size_t{1} << 31) - TileEntry::kFirstBits) {
          seen = TileEntry::kFirstBits + static_cast<std::uint32_t>(with_bits++);
        } else {
          throw std::length_error("too many visibility tiles with bits for one GPU: use more ranks");
        }
      }
      entries_.push_back(TileEntry::of(seen, summary.far));
    }
  }
  first_bits_.push_back(with_bits);
}

/// A tile of two held rows is kept with the lower one.
bool RowMatrix::is_kept_with(std::uint32_t row, std::uint32_t column) const {
  return column >= row || column < shape_.first_row;
}

std::size_t RowMatrix::read_row(std::uint32_t row, std::uint64_t* words) const {
  const TileEntry* entries = entries_.data() + std::size_t{row - shape_.first_row} * shape_.tiles;
  std::size_t count = 0;
  for (std::uint32_t column = 0; column < shape_.tiles; ++column) {
    if (entries[column].seen() < TileEntry::kFirstBits || !is_kept_with(row, column)) continue;
    read_bits_(std::min(row, column), std::max(row, column), words + kTile * count++);
  }
  return count;
}

std::uint32_t most_lines(const RowShape& shape) {
  return (shape.two_sided ? 2 : 1) * static_cast<std::uint32_t>(kMaxChannels);
}

std::uint32_t rows_at_once(const RowShape& shape) {
  const std::uint32_t wanted = kSlicesAtOnce / std::max(1u, slices_of(shape.tiles));
  return std::clamp(wanted, 1u, std::max(1u, shape.last_row - shape.first_row));
}

std::size_t device_bytes(const RowMatrix& matrix) {
  const RowShape& shape = matrix.shape();
  const std::size_t numbers_of_tile = std::size_t{most_lines(shape)} * kTile;
  const std::size_t of_slices = std::size_t{rows_at_once(shape)} * slices_of(shape.tiles) * numbers_of_tile;
  return matrix.column_numbers() * sizeof(float) + matrix.entries().size() * sizeof(TileEntry) +
         matrix.tiles_with_bits() * kTileBytes + shape.tiles * (numbers_of_tile * sizeof(float) + 1) +
         (of_slices + matrix.rows() * numbers_of_tile) * sizeof(double);
}

void require_room(const RowMatrix& matrix, std::size_t memory) {
  const std::size_t needed = device_bytes(matrix);
  if (needed > memory)
    throw DeviceError("the rows of form factors need " + megabytes(needed) +
                      " of the GPU's memory, and this rank may use " + megabytes(memory) +
                      " (use more ranks on more GPUs, larger elements, or --device cpu)");
}

}  // namespace fluxel::cuda
