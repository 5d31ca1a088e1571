#include "scene/surface_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <numbers>
#include <utility>

namespace fluxel {

namespace {

/// Of the surface's extent: how far corners may be from its plane.
constexpr double kFlat = 1e-4;

/// Directions in which the border is looked for around a cell's middle.
constexpr int kAround = 16;

/// The surface in its plane, along `across` and `up`, which the normal completes.
struct FlatSurface {
  glm::dvec3 origin{0}, across{0}, up{0}, normal{0};
  std::vector<std::vector<glm::dvec2>> polygons;
  glm::dvec2 low{std::numeric_limits<double>::max()}, high{std::numeric_limits<double>::lowest()};
};

glm::dvec3 longest_edge(std::span<const Polygon> surface) {
  glm::dvec3 longest(0);
  for (const Polygon& polygon : surface)
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const glm::dvec3 edge = polygon[(k + 1) % polygon.size()] - polygon[k];
      // Only a longer one by more than rounding: the first of equals, whatever the last digits say.
      if (glm::length(edge) > (1 + 1e-9) * glm::length(longest)) longest = edge;
    }
  return longest;
}

/// `wanted` decides between the two normals.
std::optional<FlatSurface> flatten(std::span<const Polygon> surface, const glm::dvec3& wanted) {
  glm::dvec3 whole(0);
  for (const Polygon& polygon : surface) {
    const glm::dvec3 one = area_vector(polygon);
    whole += glm::dot(one, wanted) < 0 ? -one : one;
  }
  const glm::dvec3 edge = longest_edge(surface);
  if (!(glm::length(whole) > 0) || !(glm::length(edge) > 0)) return std::nullopt;
  FlatSurface flat;
  flat.origin = surface.front().front();
  flat.normal = glm::normalize(whole);
  flat.across = glm::normalize(edge - glm::dot(edge, flat.normal) * flat.normal);
  flat.up = glm::cross(flat.normal, flat.across);
  double thickness = 0;
  for (const Polygon& polygon : surface) {
    std::vector<glm::dvec2>& corners = flat.polygons.emplace_back();
    for (const glm::dvec3& corner : polygon) {
      const glm::dvec3 way = corner - flat.origin;
      const glm::dvec2& at = corners.emplace_back(glm::dot(way, flat.across), glm::dot(way, flat.up));
      flat.low = glm::min(flat.low, at);
      flat.high = glm::max(flat.high, at);
      thickness = std::max(thickness, std::abs(glm::dot(way, flat.normal)));
    }
  }
  if (thickness > kFlat * glm::length(flat.high - flat.low)) return std::nullopt;
  return flat;
}

/// [m] into cells of `spacing` at most; none where they are too many.
std::optional<int> cells_of(double length, double spacing) {
  const double cells = std::max(1.0, std::ceil(length / spacing * (1 - 1e-9)));
  if (!(cells <= 65536)) return std::nullopt;
  return static_cast<int>(cells);
}

/// Whether a polygon, which need not be convex, holds a point: by the number of edges that a ray along x
/// crosses.
bool holds(std::span<const glm::dvec2> polygon, const glm::dvec2& at) {
  bool inside = false;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const glm::dvec2 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    if ((a.y > at.y) != (b.y > at.y) && at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x))
      inside = !inside;
  }
  return inside;
}

/// The first and the last of `count` cells of a side whose middles are between two places.
std::pair<int, int> cells_between(double from, double to, double start, double length, int count) {
  const auto cell = [&](double at) {
    return std::clamp((at - start) / length * count - 0.5, -1.0, count + 0.0);
  };
  return {static_cast<int>(std::ceil(std::max(0.0, cell(from)))),
          static_cast<int>(std::floor(std::min(count - 1.0, cell(to))))};
}

/// 1 for each cell of the rectangle whose middle, or a point at the border's distance from it, no polygon
/// holds.
std::vector<std::uint8_t> cells_off(const FlatSurface& flat, const glm::dvec2& low, const glm::dvec2& size,
                                    double border, const Receiver& receiver) {
  std::vector<glm::dvec2> points{{0, 0}};
  for (int k = 0; border > 0 && k < kAround; ++k) {
    const double angle = 2 * std::numbers::pi * k / kAround;
    points.emplace_back(border * std::cos(angle), border * std::sin(angle));
  }
  // A bit for each point that a polygon holds.
  std::vector<std::uint32_t> held(receiver.size(), 0);
  for (const std::vector<glm::dvec2>& polygon : flat.polygons) {
    glm::dvec2 from = polygon.front(), to = polygon.front();
    for (const glm::dvec2& corner : polygon) from = glm::min(from, corner), to = glm::max(to, corner);
    const auto [left, right] = cells_between(from.x - border, to.x + border, low.x, size.x, receiver.columns);
    const auto [bottom, top] = cells_between(from.y - border, to.y + border, low.y, size.y, receiver.rows);
    for (int row = bottom; row <= top; ++row)
      for (int column = left; column <= right; ++column) {
        const glm::dvec2 middle =
            low + glm::dvec2((column + 0.5) / receiver.columns, (row + 0.5) / receiver.rows) * size;
        const std::size_t cell =
            static_cast<std::size_t>(receiver.rows - 1 - row) * static_cast<std::size_t>(receiver.columns) +
            static_cast<std::size_t>(column);
        for (std::size_t k = 0; k < points.size(); ++k)
          if (holds(polygon, middle + points[k])) held[cell] |= 1u << k;
      }
  }
  const std::uint32_t all = (1u << points.size()) - 1;
  std::vector<std::uint8_t> off;
  off.reserve(held.size());
  for (const std::uint32_t bits : held) off.push_back(bits == all ? 0 : 1);
  return off;
}

}  // namespace

std::optional<std::string> lay_on_surface(std::span<const Polygon> surface, const SurfaceGrid& grid,
                                          Receiver& receiver) {
  const std::optional<FlatSurface> flat = flatten(surface, grid.normal);
  if (!flat) return "is not flat";
  if (!(glm::dot(flat->normal, glm::normalize(grid.normal)) > 0.5))
    return fmt::format(
        "has the normals ({0:.3g}, {1:.3g}, {2:.3g}) and its opposite, neither of which is near the normal "
        "given",
        flat->normal.x, flat->normal.y, flat->normal.z);
  const glm::dvec2 low = flat->low + grid.border, size = flat->high - flat->low - 2 * grid.border;
  if (!(std::min(size.x, size.y) > 0))
    return fmt::format("is {:.4g} m by {:.4g} m, of which a border of {:g} m leaves nothing",
                       flat->high.x - flat->low.x, flat->high.y - flat->low.y, grid.border);
  if (grid.spacing) {
    const std::optional<int> columns = cells_of(size.x, *grid.spacing),
                             rows = cells_of(size.y, *grid.spacing);
    if (!columns || !rows) return fmt::format("has too many cells of {:g} m", *grid.spacing);
    receiver.columns = *columns;
    receiver.rows = *rows;
  }
  if (receiver.size() > kMaxReceiverCells) return fmt::format("has more than {} cells", kMaxReceiverCells);
  receiver.origin = flat->origin + low.x * flat->across + low.y * flat->up + grid.offset * flat->normal;
  receiver.u = size.x * flat->across;
  receiver.v = size.y * flat->up;
  // Middles of a rectangle's outermost cells are farther from its edges than the border.
  std::vector<std::uint8_t> unmeasured = cells_off(*flat, low, size, (1 - 1e-9) * grid.border, receiver);
  if (std::ranges::find(unmeasured, 0) == unmeasured.end())
    return "has no cell whose middle is above it and within the border";
  if (std::ranges::find(unmeasured, 1) != unmeasured.end()) receiver.unmeasured = std::move(unmeasured);
  return std::nullopt;
}

}  // namespace fluxel
