#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/element.hpp"
#include "visibility/tile.hpp"

namespace fluxel {

/// Tells quickly which pairs of a tile may need the contour integral: moments_error and crossing_error with
/// all cosines 1, for a row of a tile at once. Most pairs of a scene end here.
class ContourFilter {
 public:
  /// `near_error`, `crossing_error`: what the pair rule's two estimates may come to.
  ContourFilter(std::span<const Element> elements, double near_error, double crossing_error);

  /// Bit c: element i and element c of the tile, i itself among them, may need it.
  [[nodiscard]] std::uint64_t candidates(std::size_t i, std::size_t tile) const;

 private:
  /// The elements of a tile as arrays; padding has no size and needs nothing.
  struct Columns {
    std::array<float, kTileSize> x{}, y{}, z{}, normal_x{}, normal_y{}, normal_z{}, variance{}, area{};
  };

  std::vector<Columns> tiles_;
  float near_error_, crossing_error_;
};

}  // namespace fluxel
