#include "mpi_master/communication/communicator_ranks.hpp"

#include "mpi_master/communication/shared_pages.hpp"

namespace fluxel {

Ranks ranks_of(const Communicator& communicator) {
  return {static_cast<std::size_t>(communicator.rank()),
          static_cast<std::size_t>(communicator.size()),
          [&communicator](std::span<std::uint64_t> values) { communicator.all_sum(values); },
          [&communicator](std::span<double> values) { communicator.all_max(values); },
          [&communicator](std::span<const std::byte> mine) { return communicator.all_gather(mine); },
          communicator.is_leader(),
          [&communicator](std::span<std::byte> bytes) { share_pages(communicator.host(), bytes); }};
}

}  // namespace fluxel
