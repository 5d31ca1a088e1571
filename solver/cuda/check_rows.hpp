#pragma once

#include <functional>
#include <memory>

#include "solver/cuda/row_gatherer.hpp"
#include "solver/cuda/row_matrix.hpp"

namespace fluxel::cuda {

/// Random elements in a cube, and random bits between them: no scene, but every kind of tile, and the most
/// work that bits can make, as columns that no row sees are rare.
struct RowCheckCase {
  std::uint32_t elements;
  Rule rule;
  bool two_sided;
  std::uint32_t channels;  ///< 1 or 3
  double nothing = 0.25;   ///< share of tiles without a pair that sees each other
  double all = 0.25;       ///< share of those where all do
  double far = 0.25;       ///< share of those for Rule::point
};

struct RowCheck {
  double pairs;             ///< of the matrix
  double gathered_pairs;    ///< of tiles that see something: those that are computed
  double upload_seconds;    ///< of the matrix, once
  double kernel_seconds;    ///< of a product
  double transfer_seconds;  ///< of a product's power and sums
  std::uint32_t compared_tile_rows;
  double largest_difference;  ///< from the host build, over the largest sum
  bool repeats;               ///< a second product, and tile rows alone, have the same bytes as the first
};

/// Makes what is to be checked, such as DeviceRows, of a matrix.
using MakeRows = std::function<std::unique_ptr<RowGatherer>(const RowMatrix&)>;

/// Compares with HostRows, for which a few tile rows are taken where the matrix is large, and takes the time
/// of a product, for which the device has been warmed. Throws what making and gathering throw.
[[nodiscard]] RowCheck check_rows(const RowCheckCase& of, const MakeRows& make);

}  // namespace fluxel::cuda
