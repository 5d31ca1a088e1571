#pragma once

#include <cstddef>
#include <cstdint>

#include "visibility/cuda/device.hpp"

namespace fluxel::cuda {

/// Makes sums of rows, what each side of an element gets from all columns, on a device or as a device does.
/// They are the same to the last bit for every split of the rows and every device, and differ from those of
/// the CPU by the rounding of single precision. For one thread at a time.
class RowGatherer {
 public:
  virtual ~RowGatherer() = default;

  /// Takes the power of all columns: of each tile a line a side and channel, as ColumnPower has them, and
  /// whether it sends anything (not 0). One or three channels. Throws DeviceError, as does gather; what has
  /// been gathered until then is right.
  virtual void start(const float* power, const std::uint8_t* sends, std::uint32_t channels) = 0;

  /// The sums of the tile rows [first, last), in the arrangement of the power, until the next call. Rows that
  /// are padding get anything.
  [[nodiscard]] virtual const double* gather(std::uint32_t first, std::uint32_t last) = 0;

  /// What all that has taken.
  [[nodiscard]] virtual DeviceSeconds seconds() const = 0;
};

}  // namespace fluxel::cuda
