#pragma once

#include <vector>

#include "mpi_master/communicator.hpp"
#include "solver/radiosity_operator.hpp"
#include "solver/row_operator.hpp"

namespace fluxel {

/// What has been exchanged between the ranks, as one of them sees it.
struct GatherCounts {
  std::uint64_t gathers = 0;  ///< of whole vectors
  std::uint64_t bytes = 0;    ///< received by this rank
  double wait_seconds = 0;    ///< after the own rows were done
};

/// The rows of all ranks as one operator: each rank does its own, in parts; a part travels to all others
/// while the next one is computed. Calls are collective.
class DistributedOperator final : public RadiosityOperator {
 public:
  /// Collective. `rows` must outlive this; `threads` work on them.
  DistributedOperator(const Communicator& communicator, RowOperator& rows, std::size_t elements,
                      bool two_sided, int threads);

  void apply(std::span<const Rgb> x, std::span<Rgb> H) override;
  void apply(std::span<const double> x, std::span<double> H) override;

  /// Gauss-Seidel inside a rank's rows, Jacobi between ranks: the values depend on the number of ranks,
  /// within the solver's tolerance.
  void sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) override;
  void sweep(std::span<const double> E, std::span<const double> rho, std::span<double> x) override;

  [[nodiscard]] const GatherCounts& gathered() const { return gathered_; }

 private:
  template <class Value>
  void apply_to(std::span<const Value> x, std::span<Value> H);
  template <class Value>
  void sweep_over(std::span<const Value> E, std::span<const Value> rho, std::span<Value> x);
  template <class Value>
  void start_gather(std::span<Value> values, std::size_t part, std::size_t parts);
  template <class Value>
  void finish_gather();
  [[nodiscard]] TileRows part_of(const TileRows& rows, std::size_t part, std::size_t parts) const;

  const Communicator& communicator_;
  RowOperator& rows_;
  std::size_t elements_;
  std::size_t sides_;
  std::vector<TileRows> of_ranks_;
  std::size_t parts_ = 1;
  GatherCounts gathered_;
};

}  // namespace fluxel
