#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "solver/cuda/check_rows.hpp"

namespace fluxel::cuda::checks {

/// A product of the solve's matrix on a device, against the host's.
struct RowFigures {
  RowCheckCase of;
  RowCheck found;

  /// Whether it agrees, and is the same when it is made again.
  [[nodiscard]] bool right() const;
};

/// Of every rule, sides and channels at the least of these sizes, then of the dearest rule at the others.
/// `memory` [bytes] may be used on the device.
[[nodiscard]] std::vector<RowFigures> check_rows_on_device(const std::vector<std::size_t>& elements,
                                                           int device, std::size_t memory);

void print_rows(const std::vector<RowFigures>& rows);

[[nodiscard]] std::string to_json(const std::vector<RowFigures>& rows);

}  // namespace fluxel::cuda::checks
