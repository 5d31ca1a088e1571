#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/element.hpp"
#include "formfactor/exchange.hpp"

namespace fluxel {

/// What may stand between the elements of two tiles, narrowed down in two steps, each taken when it is first
/// asked for: most tiles have no pair that needs to know.
class TileOccluders {
 public:
  /// Between the boxes around the elements of two tiles. The first two must outlive this.
  TileOccluders(const OcclusionScene& occlusion, const ElementView& mesh, const Box& row, const Box& column)
      : occlusion_(occlusion), mesh_(mesh), row_(row), column_(column) {}

  /// All that may stand between element i of the row's tile and any of the column's tile, until the next
  /// call; nothing where there are more than kMostCandidates between the tiles.
  [[nodiscard]] std::optional<std::span<const PatchId>> candidates(std::size_t i);

  static constexpr std::size_t kMostCandidates = 256;

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  const OcclusionScene& occlusion_;
  ElementView mesh_;
  Box row_, column_;
  bool known_ = false, too_many_ = false;
  std::vector<PatchId> of_tiles_, of_element_;
  std::size_t element_ = kNone;  // whose list of_element_ is
};

}  // namespace fluxel
