#include "mpi_master/communication/shared_columns.hpp"

#include "visibility/tile.hpp"

namespace fluxel {

SharedColumns::SharedColumns(const Communicator& host, std::span<const Element> elements)
    : tiles_(host, tile_count(elements.size())), area_(host, elements.size()) {
  const auto rank = static_cast<std::size_t>(host.rank()), ranks = static_cast<std::size_t>(host.size());
  make_columns(elements, tiles_.size() * rank / ranks, tiles_.size() * (rank + 1) / ranks, tiles_.items(),
               area_.items());
  tiles_.publish();
}

}  // namespace fluxel
