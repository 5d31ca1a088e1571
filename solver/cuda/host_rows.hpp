#pragma once

#include <vector>

#include "solver/cuda/row_gatherer.hpp"
#include "solver/cuda/row_matrix.hpp"

namespace fluxel::cuda {

/// What the device makes of rows, by the same code on the host, by one thread: to test it, and to check
/// devices. A pair costs it much more than solver/pair_kernel.
class HostRows final : public RowGatherer {
 public:
  /// Copies all bits; the matrix's columns must outlive this.
  explicit HostRows(const RowMatrix& matrix);

  void start(const float* power, const std::uint8_t* sends, std::uint32_t channels) override;
  [[nodiscard]] const double* gather(std::uint32_t first, std::uint32_t last) override;
  [[nodiscard]] DeviceSeconds seconds() const override { return seconds_; }

 private:
  RowShape shape_;
  std::vector<TileEntry> entries_;
  std::vector<std::uint64_t> bits_;
  std::vector<float> power_;
  std::vector<std::uint8_t> sends_;
  std::uint32_t channels_ = 1;
  RowView view_;
  std::vector<double> sums_;
  DeviceSeconds seconds_;
};

}  // namespace fluxel::cuda
