#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <utility>

#include "core/element.hpp"
#include "formfactor/pair_rule.hpp"
#include "solver/cuda/row_gatherer.hpp"
#include "solver/pair_kernel.hpp"
#include "visibility/tile_store.hpp"

namespace fluxel {

namespace cuda {
class RowMatrix;
}

/// The rows of a store as a device takes them; the store and the columns must outlive it. All tiles must have
/// been put.
[[nodiscard]] cuda::RowMatrix row_matrix(std::span<const Element> elements, PairColumnsView columns,
                                         const TileStore& store, const KernelRule& kernel, bool two_sided);

/// The rows on a device, for which `memory` bytes may be used there; nothing given is needed any more.
/// Throws cuda::DeviceError where that is not enough or the device cannot be used.
[[nodiscard]] std::unique_ptr<cuda::RowGatherer> make_device_rows(const cuda::RowMatrix& rows, int device,
                                                                  std::size_t memory);

/// What gathers rows in place of the CPU for as long as it works. One RowOperator after another may use it.
class RowDevice {
 public:
  using WhenItFails = std::function<void(const cuda::DeviceError&)>;

  /// When `rows` throws DeviceError it is given up, and `when_it_fails` is called: where that returns, the
  /// CPU does what was asked for and all that follows; where it throws, that is thrown on.
  RowDevice(std::unique_ptr<cuda::RowGatherer> rows, WhenItFails when_it_fails)
      : rows_(std::move(rows)), when_it_fails_(std::move(when_it_fails)) {}

  [[nodiscard]] bool works() const { return rows_ != nullptr; }

  /// As RowGatherer::start; false where the device has been given up.
  bool start(const ColumnPower& power, std::span<const std::uint8_t> sends);

  /// As RowGatherer::gather; null where the device has been given up.
  [[nodiscard]] const double* gather(TileRows rows);

  /// What it has taken, also when it has been given up.
  [[nodiscard]] cuda::DeviceSeconds seconds() const { return works() ? rows_->seconds() : taken_; }

 private:
  bool attempt(const std::function<void()>& work);

  std::unique_ptr<cuda::RowGatherer> rows_;
  WhenItFails when_it_fails_;
  cuda::DeviceSeconds taken_;
};

}  // namespace fluxel
