#pragma once

#include <span>

#include "core/element.hpp"
#include "mpi_master/communication/shared_memory.hpp"
#include "solver/pair_kernel.hpp"

namespace fluxel {

/// The columns of all elements, as row operators read them, held once a host.
class SharedColumns {
 public:
  /// Collective on the ranks of `host`, each of which makes its share.
  SharedColumns(const Communicator& host, std::span<const Element> elements);

  [[nodiscard]] PairColumnsView view() const { return {tiles_.items(), area_.items()}; }

 private:
  SharedArray<TileColumns> tiles_;
  SharedArray<float> area_;
};

}  // namespace fluxel
