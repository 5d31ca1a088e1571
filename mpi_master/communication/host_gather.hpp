#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "mpi_master/communication/communicator.hpp"
#include "mpi_master/communication/shared_memory.hpp"

namespace fluxel {

/// Collective: everybody's items one after another in the order of the ranks, held once a host. `mine` may be
/// several runs of the same length, as of fronts and backs: then all first runs come before all second ones.
/// Throws std::length_error from 2^31 items on.
template <class T>
[[nodiscard]] SharedArray<T> gather_on_hosts(const Communicator& world, std::span<const T> mine,
                                             std::size_t runs = 1) {
  const std::uint64_t count = mine.size() / runs;
  const std::vector<std::uint64_t> counts = world.all_gather(std::span(&count, 1));
  std::vector<std::size_t> first{0};  // of each rank, and the end
  for (const std::uint64_t of_rank : counts) first.push_back(first.back() + of_rank);
  std::vector<ItemRange> of_hosts;
  for (const ItemRange& ranks : world.hosts())
    of_hosts.push_back({first[ranks.first], first[ranks.first + ranks.count] - first[ranks.first]});

  SharedArray<T> all(world.host(), runs * first.back());
  const auto run_of_all = [&](std::size_t run) {
    return all.items().subspan(run * first.back(), first.back());
  };
  for (std::size_t run = 0; run < runs; ++run)
    std::ranges::copy(mine.subspan(run * count, count),
                      run_of_all(run).subspan(first[static_cast<std::size_t>(world.rank())]).begin());
  all.publish();
  if (world.is_leader()) {
    for (std::size_t run = 0; run < runs; ++run)
      world.leaders().start_gather(run_of_all(run), std::span<const ItemRange>(of_hosts));
    world.leaders().finish_gathers();
  }
  all.publish();
  return all;
}

}  // namespace fluxel
