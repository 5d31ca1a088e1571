#pragma once

#include <cstdint>
#include <glm/ext/vector_int2.hpp>
#include <glm/ext/vector_int2_sized.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "core/rgb.hpp"

namespace fluxel {

/// The middles of texels in a plane: all pieces of one plane, looked at from the same side, share them, so
/// that light is continuous from one to the next.
struct TexelLattice {
  glm::dvec3 origin{0};   ///< the middle of texel (0, 0) [m]
  glm::dvec3 u{0}, v{0};  ///< unit, of columns and rows, perpendicular to each other
  glm::dvec3 normal{0};   ///< unit, of the side that is looked at: v x u
  glm::dvec2 step{0};     ///< [m], of a column and a row

  /// Of a point of the plane [m].
  [[nodiscard]] glm::dvec2 along_axes(const glm::dvec3& point) const;
  [[nodiscard]] glm::dvec3 point(const glm::dvec2& along_axes) const {
    return origin + along_axes.x * u + along_axes.y * v;
  }
};

/// The rectangle of texels that one side of a piece needs for bilinear interpolation everywhere on it.
struct LightMapChart {
  std::uint32_t piece = 0;
  bool front = true;
  std::uint32_t lattice = 0;
  glm::i64vec2 first{0};  ///< of the lattice
  glm::ivec2 texels{0};   ///< columns and rows
  glm::ivec2 place{0};    ///< of the first one in the map: column and row
};

/// Where what lies in a light map; the same on every machine.
struct LightMapLayout {
  int width = 0, height = 0;
  double texel = 0;  ///< the largest step of a lattice [m]
  std::vector<TexelLattice> lattices;
  std::vector<LightMapChart> charts;

  /// A place of a chart's piece in the map, in texels from its upper left corner.
  [[nodiscard]] glm::dvec2 place(const LightMapChart& chart, const glm::dvec3& point) const;
};

/// Light of texels, row-major, row 0 at the top.
struct LightMap {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  LightMapLayout layout;
  std::vector<std::uint32_t> chart;  ///< that a texel belongs to, or kNone
  std::vector<Rgb> H, noise_of_H;    ///< irradiance and its standard error by rays [W/m2]
  std::size_t points = 0;            ///< at which light was gathered
  double noise =
      0;  ///< of radiosity by rays, root mean square over the mean, by what halves of them differ by
};

}  // namespace fluxel
