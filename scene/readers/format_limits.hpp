#pragma once

#include <cstddef>

namespace fluxel {

inline constexpr std::size_t kMaxFaceCorners = 4096;  ///< triangulation takes the square of it
inline constexpr double kMaxCoordinate = 1e15;        ///< far above any scene

}  // namespace fluxel
