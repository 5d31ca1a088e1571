#pragma once

#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "world.hpp"

namespace fluxel::test {

/// The ranks of the test program as if they ran on other hosts than they do.
struct HostShape {
  std::string name;
  Communicator world;
};

/// All shapes that matter: everything on one host, hosts of two, hosts of different size, hosts whose ranks
/// do not follow one another, and one rank a host; of those that are the same for so few ranks the first.
/// Collective.
inline std::vector<HostShape> host_shapes() {
  const auto on_one = [](int) { return 0; };
  const auto of_two = [](int rank) { return rank / 2; };
  const auto first_apart = [](int rank) { return rank == 0 ? 0 : 1; };
  const auto in_turn = [](int rank) { return rank % 3; };
  const auto each_alone = [](int rank) { return rank; };
  const std::vector<std::pair<std::string, std::function<int(int)>>> all{
      {"one host", on_one},
      {"hosts of two", of_two},
      {"one rank apart", first_apart},
      {"ranks assigned round-robin", in_turn},
      {"one rank a host", each_alone}};
  std::set<std::vector<int>> known;
  std::vector<HostShape> shapes;
  for (const auto& [name, host_of] : all) {
    std::vector<int> hosts;
    for (int rank = 0; rank < world().size(); ++rank) hosts.push_back(host_of(rank));
    if (known.insert(hosts).second)
      shapes.push_back({name, world().ordered_by_hosts(hosts[static_cast<std::size_t>(world().rank())])});
  }
  return shapes;
}

}  // namespace fluxel::test
