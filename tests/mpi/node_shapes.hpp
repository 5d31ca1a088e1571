#pragma once

#include <string>
#include <vector>

#include "world.hpp"

namespace fluxel::test {

/// The ranks of the test program as if they ran on other nodes than they do.
struct NodeShape {
  std::string name;
  Communicator world;
};

/// All shapes that matter: everything on one node, nodes of two, nodes of different size, nodes whose ranks
/// do not follow one another, and one rank a node. Collective.
inline std::vector<NodeShape> node_shapes() {
  const int rank = world().rank();
  return {{"one node", world().ordered_by_nodes(0)},
          {"nodes of two", world().ordered_by_nodes(rank / 2)},
          {"one rank apart", world().ordered_by_nodes(rank == 0 ? 0 : 1)},
          {"ranks assigned round-robin", world().ordered_by_nodes(rank % 3)},
          {"one rank a node", world().ordered_by_nodes(rank)}};
}

}  // namespace fluxel::test
