#pragma once

#include "mpi_master/communicator.hpp"
#include "solver/radiosity_operator.hpp"
#include "solver/row_operator.hpp"

namespace fluxel {

/// The rows of all ranks as one operator: each rank does its own, then all gather all. Calls are collective.
class DistributedOperator final : public RadiosityOperator {
 public:
  DistributedOperator(const Communicator& communicator, RowOperator& rows, std::size_t elements,
                      bool two_sided);

  void apply(std::span<const Rgb> x, std::span<Rgb> H) override;
  void apply(std::span<const double> x, std::span<double> H) override;

  /// Gauss-Seidel inside a rank's rows, Jacobi between ranks: the values depend on the number of ranks,
  /// within the solver's tolerance.
  void sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) override;
  void sweep(std::span<const double> E, std::span<const double> rho, std::span<double> x) override;

  [[nodiscard]] std::uint64_t gathered_bytes() const { return gathered_bytes_; }  ///< received by this rank

 private:
  template <class Value>
  void gather(std::span<Value> values);

  const Communicator& communicator_;
  RowOperator& rows_;
  std::size_t elements_;
  bool two_sided_;
  std::uint64_t gathered_bytes_ = 0;
};

}  // namespace fluxel
