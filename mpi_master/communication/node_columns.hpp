#pragma once

#include <span>

#include "core/element.hpp"
#include "mpi_master/communication/node_memory.hpp"
#include "solver/pair_kernel.hpp"

namespace fluxel {

/// The columns of all elements, as row operators read them, held once a node.
class NodeColumns {
 public:
  /// Collective on the ranks of `node`, each of which makes its share.
  NodeColumns(const Communicator& node, std::span<const Element> elements);

  [[nodiscard]] PairColumnsView view() const { return {tiles_.items(), area_.items()}; }

 private:
  NodeArray<TileColumns> tiles_;
  NodeArray<float> area_;
};

}  // namespace fluxel
