#pragma once

#include <functional>
#include <vector>

#include "mpi_master/communication/communicator.hpp"
#include "mpi_master/communication/host_team.hpp"
#include "solver/radiosity_operator.hpp"
#include "solver/row_operator.hpp"

namespace fluxel {

/// What has been gathered between the hosts, as one of them sees it.
struct GatherCounts {
  std::uint64_t gathers = 0;  ///< of whole vectors
  std::uint64_t bytes = 0;    ///< received by this host
  double wait_seconds = 0;    ///< after the leader's own rows were done, also for ranks of its host
};

/// The rows of all ranks as one operator: each rank does its own, in parts; a part travels to the other hosts
/// while the next one is computed. Vectors are the leaders': these apply the operator, all alike, and what
/// the other ranks of a host read and write is in memory that they share.
class DistributedOperator final : public RadiosityOperator {
 public:
  /// Collective. `rows` must outlive this; `threads` work on them.
  DistributedOperator(const Communicator& communicator, RowOperator& rows, std::size_t elements,
                      bool two_sided, int threads);

  /// Collective: leaders do the work, which may apply this operator any number of times, and meet nobody but
  /// leaders in it; the other ranks serve them until it is done. InputError of the work is everybody's, as in
  /// `agree`, and so is StopRequest, which all leaders must throw together.
  void lead(const std::function<void()>& work);

  // By leaders, inside `lead`.
  void apply(std::span<const Rgb> x, std::span<Rgb> H) override;
  void apply(std::span<const double> x, std::span<double> H) override;

  /// Gauss-Seidel inside a rank's rows, Jacobi between ranks: the values depend on the number of ranks,
  /// within the solver's tolerance.
  void sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) override;
  void sweep(std::span<const double> E, std::span<const double> rho, std::span<double> x) override;

  [[nodiscard]] const GatherCounts& gathered() const { return gathered_; }

 private:
  /// Of a host's vectors, where it has several ranks.
  enum class Shared : std::size_t { x, H, E, rho };
  static constexpr std::size_t kSharedVectors = 4;

  template <class Value>
  class VectorGather;

  template <class Value>
  void apply_to(std::span<const Value> x, std::span<Value> H);
  template <class Value>
  void sweep_over(std::span<const Value> E, std::span<const Value> rho, std::span<Value> x);
  template <class Value>
  void apply_own_rows(std::span<const Value> x, std::span<Value> H, const std::function<void()>& after_part);
  template <class Value>
  void sweep_own_rows();
  void call(TeamTask task);
  void serve();

  template <class Value>
  [[nodiscard]] std::span<Value> shared(Shared vector);
  [[nodiscard]] ItemRange elements_of(const TileRows& rows) const;

  Communicator communicator_;
  RowOperator& rows_;
  std::size_t elements_;
  std::size_t sides_;
  std::vector<TileRows> of_ranks_;
  std::size_t max_ranks_on_host_ = 1;
  std::size_t parts_ = 1;
  HostTeam team_;
  SharedArray<Rgb> vectors_;
  bool leading_ = false;
  GatherCounts gathered_;
};

}  // namespace fluxel
