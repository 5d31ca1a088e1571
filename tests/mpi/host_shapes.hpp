#pragma once

#include <string>
#include <vector>

#include "world.hpp"

namespace fluxel::test {

/// The ranks of the test program as if they ran on other hosts than they do.
struct HostShape {
  std::string name;
  Communicator world;
};

/// All shapes that matter: everything on one host, hosts of two, hosts of different size, hosts whose ranks
/// do not follow one another, and one rank a host. Collective.
inline std::vector<HostShape> host_shapes() {
  const int rank = world().rank();
  return {{"one host", world().ordered_by_hosts(0)},
          {"hosts of two", world().ordered_by_hosts(rank / 2)},
          {"one rank apart", world().ordered_by_hosts(rank == 0 ? 0 : 1)},
          {"ranks assigned round-robin", world().ordered_by_hosts(rank % 3)},
          {"one rank a host", world().ordered_by_hosts(rank)}};
}

}  // namespace fluxel::test
