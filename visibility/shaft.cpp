#include "visibility/shaft.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <stdexcept>

#include "visibility/cuts_off.hpp"
#include "visibility/range_along.hpp"

namespace fluxel {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// Largest value of dot(direction, x) in the box.
double farthest_along(const glm::dvec3& direction, const Box& box) {
  const glm::dvec3 ends = glm::max(direction * box.low, direction * box.high);
  return ends.x + ends.y + ends.z;
}

/// True where the box, which may be flat, reaches deeper than epsilon into the hull's bounds.
bool enters(const Box& box, const Box& hull, double epsilon) {
  return glm::all(glm::lessThan(box.low, hull.high - epsilon)) &&
         glm::all(glm::greaterThan(box.high, hull.low + epsilon));
}

}  // namespace

std::array<glm::dvec3, 8> corners_of(const Box& box) {
  std::array<glm::dvec3, 8> corner;
  for (unsigned k = 0; k < 8; ++k) {
    corner[k] = {(k & 1u) != 0 ? box.high.x : box.low.x, (k & 2u) != 0 ? box.high.y : box.low.y,
                 (k & 4u) != 0 ? box.high.z : box.low.z};
  }
  return corner;
}

Box bounds(std::span<const glm::dvec3> points) {
  Box box{glm::dvec3(kUnbounded), glm::dvec3(-kUnbounded)};
  for (const glm::dvec3& x : points) {
    box.low = glm::min(box.low, x);
    box.high = glm::max(box.high, x);
  }
  return box;
}

Shaft::Shaft(PolygonView a, PolygonView b) : corners_(a.size() + b.size()), first_corners_(a.size()) {
  if (std::min(a.size(), b.size()) < 3 || std::max(a.size(), b.size()) > kMaxCorners) {
    throw std::logic_error("a shaft needs polygons of 3 to 8 corners");
  }
  std::copy(b.begin(), b.end(), std::copy(a.begin(), a.end(), corner_.begin()));
  bounds_ = bounds(corners());
  add_planes_of(a, b);
  add_planes_of(b, a);
}

Shaft::Shaft(const Box& a, const Box& b) : corners_(16), first_corners_(8) {
  const std::array<glm::dvec3, 8> first = corners_of(a), second = corners_of(b);
  std::copy(second.begin(), second.end(), std::copy(first.begin(), first.end(), corner_.begin()));
  bounds_ = bounds(corners());
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 direction(0);
    direction[axis] = 1;
    add_supporting_plane(direction);
    add_supporting_plane(-direction);
    // Seen along the axis the boxes are rectangles. At each corner of their bounds where one reaches farther
    // in u and the other in v, a plane through a corner of each cuts it off.
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const bool high_u : {false, true}) {
      for (const bool high_v : {false, true}) {
        const double du = high_u ? a.high[u] - b.high[u] : b.low[u] - a.low[u];
        const double dv = high_v ? a.high[v] - b.high[v] : b.low[v] - a.low[v];
        if (du * dv >= 0) continue;
        direction[axis] = 0;
        direction[u] = (high_u ? -1 : 1) * std::abs(dv);
        direction[v] = (high_v ? -1 : 1) * std::abs(du);
        add_supporting_plane(direction);
      }
    }
  }
}

/// The plane that touches the hull from behind: whatever the direction, nothing of the hull is cut off.
void Shaft::add_supporting_plane(const glm::dvec3& direction) {
  const double squared = glm::dot(direction, direction);
  if (!(squared > 0)) return;
  const glm::dvec3 normal = direction / std::sqrt(squared);
  double offset = kUnbounded;
  for (const glm::dvec3& x : corners()) offset = std::min(offset, glm::dot(normal, x));
  plane_[planes_++] = {normal, offset};
}

/// The plane of `from` and those through one of its edges and a corner of `to`.
void Shaft::add_planes_of(PolygonView from, PolygonView to) {
  const glm::dvec3 area = area_vector(from);
  std::array<double, kMaxCorners> height;  // of the corners of `to` above the plane of `from`
  double sum = 0;
  for (std::size_t k = 0; k < to.size(); ++k) sum += height[k] = glm::dot(area, to[k] - from[0]);
  const double sign = sum < 0 ? -1 : 1;
  add_supporting_plane(sign * area);

  for (std::size_t i = 0; i < from.size(); ++i) {
    const glm::dvec3& start = from[i];
    const glm::dvec3 edge = from[i + 1 < from.size() ? i + 1 : 0] - start;
    const glm::dvec3 outward = glm::cross(edge, area);
    const double edge_squared = glm::dot(edge, edge);
    // Seen along the edge, `from` is a ray and `to` lies on one side of its line: the plane through the
    // corner that is farthest around has both on one side. Corners on the edge's own line have no direction;
    // in the coordinates here lengths across the edge are multiplied by |edge| |area|.
    constexpr double kOnLine = 1e-20;  // of the edge's length, squared
    const double on_line = kOnLine * edge_squared * edge_squared * glm::dot(area, area);
    double best_across = -1, best_up = 0;
    bool found = false;
    for (std::size_t k = 0; k < to.size(); ++k) {
      const double across = glm::dot(outward, to[k] - start);
      const double up = std::max(0.0, sign * height[k]);
      if (across * across + up * up * edge_squared <= on_line) continue;
      if (!found || best_across * up < across * best_up) {
        best_across = across;
        best_up = up;
        found = true;
      }
    }
    if (found) add_supporting_plane(sign * best_across * area - best_up * outward);
  }
}

bool Shaft::may_meet(const Box& box, double epsilon) const {
  if (!enters(box, bounds_, epsilon)) return false;
  return std::ranges::all_of(planes(), [&](const HalfSpace& plane) {
    return farthest_along(plane.normal, box) - plane.offset > epsilon;
  });
}

bool Shaft::may_meet(const Outline<glm::dvec3>& patch, double epsilon) const {
  const PolygonView outline = fluxel::corners(patch);
  if (!enters(bounds(outline), bounds_, epsilon)) return false;

  std::array<const HalfSpace*, kMaxPlanes> cutting;
  std::size_t cuts = 0;
  for (const HalfSpace& plane : planes()) {
    const Range range = range_along(plane.normal, outline);
    if (range.high - plane.offset <= epsilon) return false;
    if (range.low - plane.offset <= epsilon) cutting[cuts++] = &plane;
  }

  const glm::dvec3 normal = area_vector(outline);
  const double slack = epsilon * glm::length(normal);
  const Range of_patch = range_along(normal, outline), of_hull = range_along(normal, corners());
  if (of_hull.low >= of_patch.high - slack || of_hull.high <= of_patch.low + slack) return false;

  // What is left of the patch deeper than epsilon inside (Sutherland & Hodgman, Reentrant polygon clipping,
  // 1974); each plane adds at most one corner.
  using Clipped = std::array<glm::dvec3, 4 + kMaxPlanes>;
  Clipped buffers[2];
  std::size_t count = outline.size();
  std::copy(outline.begin(), outline.end(), buffers[0].begin());
  for (std::size_t k = 0; k < cuts; ++k) {
    const Clipped& from = buffers[k % 2];
    Clipped& to = buffers[(k + 1) % 2];
    const auto depth = [&](const glm::dvec3& x) {
      return glm::dot(cutting[k]->normal, x) - cutting[k]->offset - epsilon;
    };
    std::size_t kept = 0;
    glm::dvec3 last = from[count - 1];
    double last_depth = depth(last);
    for (std::size_t i = 0; i < count; ++i) {
      // Rounding can bend a sliver so that it is cut more than twice.
      if (kept + 2 > to.size()) return true;
      const double here = depth(from[i]);
      if ((here > 0) != (last_depth > 0)) {
        to[kept++] = last + (from[i] - last) * (last_depth / (last_depth - here));
      }
      if (here > 0) to[kept++] = from[i];
      last = from[i];
      last_depth = here;
    }
    if (kept == 0) return false;
    count = kept;
  }
  return true;
}

bool Shaft::blocks(const Outline<glm::dvec3>& patch, double epsilon) const {
  return cuts_off(corners().first(first_corners_), corners().subspan(first_corners_), fluxel::corners(patch),
                  epsilon);
}

}  // namespace fluxel
