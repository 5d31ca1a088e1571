#pragma once

#include <cstdint>
#include <vector>

#include "mpi_master/communication/communicator.hpp"
#include "mpi_master/communication/shared_memory.hpp"
#include "solver/column_power.hpp"
#include "visibility/tile_store.hpp"

namespace fluxel {

/// What has been gathered between the hosts, as one of them sees it.
struct GatherCounts {
  std::uint64_t gathers = 0;  ///< of the power of all columns
  std::uint64_t bytes = 0;    ///< received by this host
  double wait_seconds = 0;    ///< of the leader, from its own part's being set, also for ranks of its host
};

/// The power of all columns, held once a host: each rank sets that of its own tiles, then leaders gather from
/// leaders what their hosts have.
class HostPower final : public PowerExchange {
 public:
  /// Collective. `owned`: this rank's tile rows, ascending with the ranks and one after another.
  HostPower(const Communicator& communicator, const TileRows& owned, bool two_sided);

  [[nodiscard]] const Ranks& ranks() const override { return ranks_; }
  [[nodiscard]] SentPower room(std::size_t channels) override;
  void exchange(SentPower& sent) override;

  [[nodiscard]] const GatherCounts& gathered() const { return gathered_; }

 private:
  void gather(SentPower& sent);

  Communicator communicator_;
  Ranks ranks_;
  std::size_t sides_;
  std::vector<ItemRange> tiles_of_hosts_;
  SharedArray<ColumnPower::Line> lines_;
  SharedArray<std::uint8_t> sends_;
  GatherCounts gathered_;
};

}  // namespace fluxel
