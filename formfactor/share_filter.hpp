#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/element.hpp"
#include "formfactor/power_estimate.hpp"
#include "visibility/tile.hpp"

namespace fluxel {

/// Tells quickly which pairs may be worth a share of the power.
class ShareFilter {
 public:
  ShareFilter(std::span<const Element> elements, const PowerEstimate& power);

  /// Bits of the columns of a tile whose pair with element i may have a share above `least`: none is left out
  /// that PowerEstimate::share by PairRule::disc gives one of the centroids' sides.
  [[nodiscard]] std::uint64_t above(double least, std::size_t i, std::size_t tile) const;

 private:
  struct alignas(64) Columns {
    std::array<float, kTileSize> x{}, y{}, z{}, normal_x{}, normal_y{}, normal_z{};
    std::array<float, kTileSize> power{};      ///< area times B of the side with more [W], over pi
    std::array<float, kTileSize> inverse_H{};  ///< of the darker side [m2/W]
  };

  std::vector<Columns> tiles_;
};

}  // namespace fluxel
