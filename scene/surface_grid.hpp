#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/polygon.hpp"
#include "scene/receiver.hpp"

namespace fluxel {

/// A grid of light meters beside a flat surface, as a user asks for it.
struct SurfaceGrid {
  glm::dvec3 normal{0};  ///< which of the surface's two normals is meant: that within 60 degrees of it
  double offset = 0;     ///< along that normal [m]
  double border = 0;     ///< along the surface's outline, that is left out [m]
  std::optional<double> spacing;  ///< largest side of a cell [m]; unset: the receiver's columns and rows
};

/// Lays the receiver's grid over the smallest rectangle around the polygons that is parallel to the longest
/// straight piece of their common outline, less the border. Cells whose middle is not above a polygon, or
/// nearer than the border to where none is, are left out. Returns what stands against it, as the end of a
/// sentence, or nothing.
[[nodiscard]] std::optional<std::string> lay_on_surface(std::span<const Polygon> surface,
                                                        const SurfaceGrid& grid, Receiver& receiver);

/// Cells of a receiver, at most.
inline constexpr std::size_t kMaxReceiverCells = std::size_t{1} << 24;

}  // namespace fluxel
