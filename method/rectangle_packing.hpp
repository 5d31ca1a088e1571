#pragma once

#include <span>

namespace fluxel {

/// A rectangle of whole numbers, and where it has been placed.
struct PackedRectangle {
  int width = 0, height = 0;
  int x = 0, y = 0;
};

/// Places all of them in a larger one without overlaps, from its corner on; false where they have no room.
/// The same input gives the same places. None is wider or higher than 65535.
[[nodiscard]] bool pack(std::span<PackedRectangle> rectangles, int width, int height);

}  // namespace fluxel
