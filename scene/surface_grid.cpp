#include "scene/surface_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <map>
#include <utility>

namespace fluxel {

namespace {

/// Of the surface's extent: how far corners may be from its plane.
constexpr double kFlat = 1e-4;

/// Of the surface's extent: corners nearer than that are one; how far beside an edge it is asked what lies
/// there.
constexpr double kSame = 1e-7, kBeside = 1e-6;

/// Parts of an edge of which each may be an outline or lie between polygons.
constexpr int kParts = 16;

/// The surface in its plane, along `across` and `up`, which the normal completes.
struct FlatSurface {
  glm::dvec3 origin{0}, across{0}, up{0}, normal{0};
  std::vector<std::vector<glm::dvec2>> polygons;
  glm::dvec2 low{std::numeric_limits<double>::max()}, high{std::numeric_limits<double>::lowest()};
};

/// `wanted` decides between the two normals.
std::optional<FlatSurface> flatten(std::span<const Polygon> surface, const glm::dvec3& wanted) {
  glm::dvec3 whole(0);
  for (const Polygon& polygon : surface) {
    const glm::dvec3 one = area_vector(polygon);
    whole += glm::dot(one, wanted) < 0 ? -one : one;
  }
  if (!(glm::length(whole) > 0)) return std::nullopt;
  FlatSurface flat;
  flat.origin = surface.front().front();
  flat.normal = glm::normalize(whole);
  const glm::dvec3 edge = surface.front()[1] - flat.origin;
  const glm::dvec3 in_plane = edge - glm::dot(edge, flat.normal) * flat.normal;
  if (!(glm::length(in_plane) > 0)) return std::nullopt;
  flat.across = glm::normalize(in_plane);
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

/// Where the line through an edge's ends is at a height between them. From the lower end, so that polygons on
/// both sides of an edge agree.
double crossing(glm::dvec2 a, glm::dvec2 b, double y) {
  if (std::pair(b.y, b.x) < std::pair(a.y, a.x)) std::swap(a, b);
  return a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
}

/// Where a polygon, which need not be convex, begins and ends along a line of constant y, in turns.
std::vector<double> crossings(std::span<const glm::dvec2> polygon, double y) {
  std::vector<double> found;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const glm::dvec2 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    if ((a.y > y) != (b.y > y)) found.push_back(crossing(a, b, y));
  }
  std::ranges::sort(found);
  return found;
}

bool holds(const FlatSurface& flat, const glm::dvec2& at) {
  return std::ranges::any_of(flat.polygons, [&](const std::vector<glm::dvec2>& polygon) {
    const std::vector<double> ends = crossings(polygon, at.y);
    return (std::ranges::upper_bound(ends, at.x) - ends.begin()) % 2 == 1;
  });
}

using Edge = std::array<glm::dvec2, 2>;

/// The edges that no second polygon has: outlines, and those along which corners of others lie.
std::vector<Edge> single_edges(const FlatSurface& flat) {
  const double same = kSame * glm::length(flat.high - flat.low);
  const auto place = [&](const glm::dvec2& at) {
    return std::pair(std::llround((at.x - flat.low.x) / same), std::llround((at.y - flat.low.y) / same));
  };
  std::map<std::pair<std::pair<long long, long long>, std::pair<long long, long long>>, std::pair<Edge, int>>
      edges;
  for (const std::vector<glm::dvec2>& polygon : flat.polygons)
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Edge edge{polygon[k], polygon[(k + 1) % polygon.size()]};
      const auto from = place(edge[0]), to = place(edge[1]);
      if (from == to) continue;
      auto& [first, count] = edges.try_emplace(std::minmax(from, to), edge, 0).first->second;
      ++count;
    }
  std::vector<Edge> found;
  for (const auto& [ends, edge] : edges)
    if (edge.second == 1) found.push_back(edge.first);
  return found;
}

/// The surface's outline, its holes' among it: of each single edge the parts that have no surface on one
/// side.
std::vector<Edge> outline(const FlatSurface& flat) {
  const double beside = kBeside * glm::length(flat.high - flat.low);
  std::vector<Edge> found;
  for (const Edge& edge : single_edges(flat)) {
    const glm::dvec2 way = edge[1] - edge[0];
    const glm::dvec2 aside = beside / glm::length(way) * glm::dvec2(-way.y, way.x);
    bool goes_on = false;
    for (int k = 0; k < kParts; ++k) {
      const glm::dvec2 from = edge[0] + (k / static_cast<double>(kParts)) * way;
      const glm::dvec2 to = edge[0] + ((k + 1) / static_cast<double>(kParts)) * way,
                       middle = 0.5 * (from + to);
      const bool is_outline = !holds(flat, middle + aside) || !holds(flat, middle - aside);
      if (is_outline && goes_on) found.back()[1] = to;
      if (is_outline && !goes_on) found.push_back({from, to});
      goes_on = is_outline;
    }
  }
  return found;
}

/// Turns the axes along the longest straight piece of the outline, the first of equals.
void turn_along(std::span<const Edge> outline, FlatSurface& flat) {
  glm::dvec2 longest(0);
  for (const Edge& edge : outline)
    if (glm::length(edge[1] - edge[0]) > (1 + 1e-9) * glm::length(longest)) longest = edge[1] - edge[0];
  if (!(glm::length(longest) > 0)) return;
  const glm::dvec2 x = glm::normalize(longest), y(-x.y, x.x);
  const glm::dvec3 across = x.x * flat.across + x.y * flat.up;
  flat.up = y.x * flat.across + y.y * flat.up;
  flat.across = across;
  flat.low = glm::dvec2(std::numeric_limits<double>::max());
  flat.high = glm::dvec2(std::numeric_limits<double>::lowest());
  for (std::vector<glm::dvec2>& polygon : flat.polygons)
    for (glm::dvec2& corner : polygon) {
      corner = {glm::dot(corner, x), glm::dot(corner, y)};
      flat.low = glm::min(flat.low, corner);
      flat.high = glm::max(flat.high, corner);
    }
}

double squared_distance(const glm::dvec2& at, const Edge& edge) {
  const glm::dvec2 way = edge[1] - edge[0], from = at - edge[0];
  const double t = std::clamp(glm::dot(from, way) / glm::dot(way, way), 0.0, 1.0);
  const glm::dvec2 off = from - t * way;
  return glm::dot(off, off);
}

/// Which cells of a rectangle are measured.
class CellMask {
 public:
  CellMask(const glm::dvec2& low, const glm::dvec2& size, const Receiver& receiver)
      : low_(low), size_(size), columns_(receiver.columns), rows_(receiver.rows), off_(receiver.size(), 1) {}

  /// Those whose middles the polygon holds.
  void add(std::span<const glm::dvec2> polygon) {
    const auto [low, high] = std::ranges::minmax(polygon, {}, &glm::dvec2::y);
    const auto [bottom, top] = between(low.y, high.y, low_.y, size_.y, rows_);
    for (int row = bottom; row <= top; ++row) {
      const std::vector<double> ends = crossings(polygon, middle(0, row).y);
      for (std::size_t k = 0; k + 1 < ends.size(); k += 2) {
        const auto [left, right] = between(ends[k], ends[k + 1], low_.x, size_.x, columns_);
        for (int column = left; column <= right; ++column) off_[cell(column, row)] = 0;
      }
    }
  }

  /// Those nearer to an edge than that.
  void remove_near(const Edge& edge, double distance) {
    const glm::dvec2 from = glm::min(edge[0], edge[1]) - distance, to = glm::max(edge[0], edge[1]) + distance;
    const auto [left, right] = between(from.x, to.x, low_.x, size_.x, columns_);
    const auto [bottom, top] = between(from.y, to.y, low_.y, size_.y, rows_);
    for (int row = bottom; row <= top; ++row)
      for (int column = left; column <= right; ++column)
        if (squared_distance(middle(column, row), edge) < distance * distance) off_[cell(column, row)] = 1;
  }

  [[nodiscard]] std::vector<std::uint8_t> off() && { return std::move(off_); }

 private:
  [[nodiscard]] glm::dvec2 middle(int column, int row) const {
    return low_ + glm::dvec2((column + 0.5) / columns_, (row + 0.5) / rows_) * size_;
  }
  /// Row 0 is the last.
  [[nodiscard]] std::size_t cell(int column, int row) const {
    return static_cast<std::size_t>(rows_ - 1 - row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  /// The first and the last of `count` cells of a side whose middles are between two places.
  static std::pair<int, int> between(double from, double to, double start, double length, int count) {
    const double first = std::ceil((from - start) / length * count - 0.5),
                 last = std::floor((to - start) / length * count - 0.5);
    return {static_cast<int>(std::clamp(first, 0.0, count + 0.0)),
            static_cast<int>(std::clamp(last, -1.0, count - 1.0))};
  }

  glm::dvec2 low_, size_;
  int columns_, rows_;
  std::vector<std::uint8_t> off_;
};

}  // namespace

std::optional<std::string> lay_on_surface(std::span<const Polygon> surface, const SurfaceGrid& grid,
                                          Receiver& receiver) {
  std::optional<FlatSurface> flat = flatten(surface, grid.normal);
  if (!flat) return "is not flat";
  turn_along(outline(*flat), *flat);
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
  CellMask mask(low, size, receiver);
  for (const std::vector<glm::dvec2>& polygon : flat->polygons) mask.add(polygon);
  // Middles of a rectangle's outermost cells are farther from its edges than the border.
  if (grid.border > 0)
    for (const Edge& edge : outline(*flat)) mask.remove_near(edge, (1 - 1e-9) * grid.border);
  std::vector<std::uint8_t> unmeasured = std::move(mask).off();
  if (std::ranges::find(unmeasured, 0) == unmeasured.end())
    return "has no cell whose middle is above it and within the border";
  if (std::ranges::find(unmeasured, 1) != unmeasured.end()) receiver.unmeasured = std::move(unmeasured);
  return std::nullopt;
}

}  // namespace fluxel
