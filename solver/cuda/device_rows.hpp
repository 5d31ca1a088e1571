#pragma once

#include <memory>

#include "solver/cuda/row_gatherer.hpp"
#include "solver/cuda/row_matrix.hpp"

namespace fluxel::cuda {

/// Gathers rows on a device, which keeps geometry and bits; power goes there and sums come back.
class DeviceRows final : public RowGatherer {
 public:
  /// Copies the matrix to a device, which may take seconds. Throws DeviceError where it needs more than
  /// `memory` bytes there (device_bytes), or the device cannot be used.
  DeviceRows(const RowMatrix& matrix, int device, std::size_t memory);
  ~DeviceRows() override;

  void start(const float* power, const std::uint8_t* sends, std::uint32_t channels) override;
  [[nodiscard]] const double* gather(std::uint32_t first, std::uint32_t last) override;
  [[nodiscard]] DeviceSeconds seconds() const override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fluxel::cuda
