#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace fluxel {

/// What a receiver measures, at each of its places.
enum class Quantity {
  irradiance,       ///< of the side that the normal points to [W/m2] or [lx]
  cylindrical,      ///< mean irradiance of a small cylinder's curved surface (EN 12665) [W/m2] or [lx]
  semicylindrical,  ///< of the half of it whose middle faces a direction (EN 13201-2) [W/m2] or [lx]
  radiance          ///< mean over the cone of a direction, of surfaces alone [W/(m2 sr)] or [cd/m2]
};

/// A virtual light meter, which hides nothing and sends nothing: a grid of cells over a parallelogram, each
/// measured over its area, or a row of single points.
struct Receiver {
  std::string name;
  Quantity quantity = Quantity::irradiance;
  glm::dvec3 origin{0};  ///< corner of the grid [m]
  glm::dvec3 u{0};       ///< edge along which the columns follow one another [m]
  glm::dvec3 v{0};       ///< edge along the rows [m]
  int columns = 1;       ///< of points their number
  int rows = 1;
  std::vector<glm::dvec3> points;  ///< in place of the grid [m]; empty: there is a grid
  std::vector<std::uint8_t>
      unmeasured;  ///< 1 for each cell that is left out, row 0 last along v; empty: none
  /// Unit: of irradiance at points the normal (a grid has that of u x v), of cylinders the axis, of radiance
  /// the cone's.
  glm::dvec3 direction{0, 0, 1};
  glm::dvec3 facing{1, 0, 0};  ///< unit, normal to `direction`: of half a cylinder
  double half_angle = 0;       ///< of the cone [rad], up to a right angle

  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }
  [[nodiscard]] bool is_grid() const { return points.empty(); }
  [[nodiscard]] bool measures(std::size_t cell) const { return unmeasured.empty() || unmeasured[cell] == 0; }

  /// A place of a cell from the unit square, row 0 the last along v; of a point the point [m].
  [[nodiscard]] glm::dvec3 place(std::size_t cell, double s, double t) const {
    if (!is_grid()) return points[cell];
    const std::size_t column = cell % static_cast<std::size_t>(columns);
    const std::size_t row = cell / static_cast<std::size_t>(columns);
    return origin + (static_cast<double>(column) + s) / columns * u +
           (1 - (static_cast<double>(row) + t) / rows) * v;
  }
};

}  // namespace fluxel
