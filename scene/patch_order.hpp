#pragma once

#include <array>
#include <cstdint>

#include "scene/scene.hpp"

namespace fluxel {

/// The place of a cell along the Hilbert curve through a cube of 2^21 cells a side (Skilling 2004,
/// "Programming the Hilbert curve"): cells that follow one another share a face.
[[nodiscard]] std::uint64_t hilbert_key(std::array<std::uint32_t, 3> cell);

/// Sorts the pieces by their patches' centroids along the curve over the scene's box, ties by patch number;
/// the pieces of a patch stay together and in their order.
void order_pieces(Scene& scene);

}  // namespace fluxel
