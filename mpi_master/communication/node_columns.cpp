#include "mpi_master/communication/node_columns.hpp"

#include "visibility/tile.hpp"

namespace fluxel {

NodeColumns::NodeColumns(const Communicator& node, std::span<const Element> elements)
    : tiles_(node, tile_count(elements.size())), area_(node, elements.size()) {
  const auto rank = static_cast<std::size_t>(node.rank()), ranks = static_cast<std::size_t>(node.size());
  make_columns(elements, tiles_.size() * rank / ranks, tiles_.size() * (rank + 1) / ranks, tiles_.items(),
               area_.items());
  tiles_.publish();
}

}  // namespace fluxel
