#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/ids.hpp"

namespace fluxel {

/// What the rays through the pixels' centres see first. Row-major, row 0 at the top; all vectors have
/// width * height entries.
struct Raster {
  int width = 0;
  int height = 0;
  std::vector<double> depth;        ///< along the view axis [m]; infinity where nothing is seen
  std::vector<PatchId> patch;       ///< kNoPatch where nothing is seen
  std::vector<ElementId> element;   ///< filled by the subdivision
  std::vector<std::uint8_t> front;  ///< 1 where the front of the patch is seen

  [[nodiscard]] std::size_t pixels() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};

}  // namespace fluxel
