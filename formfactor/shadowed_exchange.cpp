#include "formfactor/shadowed_exchange.hpp"

#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>
#include <utility>

namespace fluxel {

namespace {

constexpr std::size_t kMaxLitParts = 48, kMaxPartCorners = 16;
constexpr int kMaxQuarterings = 6;

/// A convex part of the receiving polygon, in its plane [m].
using Part = boost::container::static_vector<glm::dvec2, kMaxPartCorners>;
using Parts = boost::container::static_vector<Part, kMaxLitParts>;

/// In the receiving plane: where a u + b v + c >= 0 [m].
struct Line {
  double a = 0, b = 0, c = 0;
};

/// The shadow is where all hold.
using Shadow = boost::container::static_vector<Line, 5>;

struct FlatOccluder {
  boost::container::static_vector<glm::dvec3, 4> corners;
  glm::dvec3 normal{0};  // unit
};

/// A triangle at (1 - s - t) or a parallelogram at (s, t) of its edges.
struct Cell {
  glm::dvec3 corner{0}, u{0}, v{0};
  bool triangle = false;
};

/// Parts of a polygon on both sides of a line; corners within the tolerance lie on it.
void cut(const Part& part, std::span<const double> heights, Part& in, Part& out) {
  in.clear();
  out.clear();
  for (std::size_t k = 0; k < part.size(); ++k) {
    const std::size_t next = k + 1 < part.size() ? k + 1 : 0;
    const double h = heights[k], h_next = heights[next];
    if (h >= 0) in.push_back(part[k]);
    if (h <= 0) out.push_back(part[k]);
    if ((h < 0 && h_next > 0) || (h > 0 && h_next < 0)) {
      const glm::dvec2 crossing = part[k] + h / (h - h_next) * (part[next] - part[k]);
      in.push_back(crossing);
      out.push_back(crossing);
    }
  }
}

/// A unit vector in a polygon's plane. Clipping may have left two corners in one place, or so near to each
/// other that rounding turns what joins them: hence along the longest edge.
glm::dvec3 direction_in(const SampledPolygon& polygon) {
  glm::dvec3 longest(0), last = polygon.corners.back();
  for (const glm::dvec3& corner : polygon.corners) {
    if (const glm::dvec3 edge = corner - last; glm::dot(edge, edge) > glm::dot(longest, longest))
      longest = edge;
    last = corner;
  }
  return glm::normalize(longest - glm::dot(longest, polygon.normal) * polygon.normal);
}

class ShadowIntegral {
 public:
  ShadowIntegral(const SampledPolygon& from, const SampledPolygon& to, std::span<const PolygonView> occluders,
                 double lift)
      : lift_(lift), origin_(to.corners[0]), axis_x_(direction_in(to)), axis_z_(to.normal) {
    axis_y_ = glm::cross(axis_z_, axis_x_);
    for (const glm::dvec3& corner : to.corners) {
      const glm::dvec3 place = in_frame(corner);
      whole_.push_back({place.x, place.y});
    }
    for (const PolygonView outline : occluders) {
      FlatOccluder occluder;
      for (const glm::dvec3& corner : outline) occluder.corners.push_back(in_frame(corner));
      occluder.normal = turned(glm::normalize(area_vector(outline)));
      occluders_.push_back(occluder);
    }
    normal_ = turned(from.normal);
    add_cells(from.corners);
  }

  [[nodiscard]] bool integrate(double tolerance, ShadowedArea& found) {
    double area = 0;
    for (const Cell& cell : cells_) area += area_of(cell);
    double variance = 0;
    for (const Cell& cell : cells_) {
      double whole = 0;
      if (!by_rule(cell, whole)) return false;
      if (!refine(cell, whole, tolerance * std::sqrt(area_of(cell) / area), 0, found.G, variance))
        return false;
    }
    found.error = std::sqrt(variance);
    return true;
  }

 private:
  [[nodiscard]] glm::dvec3 turned(const glm::dvec3& v) const {
    return {glm::dot(v, axis_x_), glm::dot(v, axis_y_), glm::dot(v, axis_z_)};
  }
  [[nodiscard]] glm::dvec3 in_frame(const glm::dvec3& x) const { return turned(x - origin_); }

  void add_cells(const SmallPolygon& polygon) {
    const auto x = [&](std::size_t k) { return in_frame(polygon[k]); };
    if (polygon.size() == 4) {
      const glm::dvec3 gap = x(0) - x(1) + x(2) - x(3);
      if (glm::length(gap) <= lift_) {
        cells_.push_back({x(0), x(1) - x(0), x(3) - x(0), false});
        return;
      }
    }
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
      cells_.push_back({x(0), x(k) - x(0), x(k + 1) - x(0), true});
  }

  static double area_of(const Cell& cell) {
    return (cell.triangle ? 0.5 : 1.0) * glm::length(glm::cross(cell.u, cell.v));
  }

  static std::array<Cell, 4> quarters(const Cell& cell) {
    const glm::dvec3 u = 0.5 * cell.u, v = 0.5 * cell.v;
    return {Cell{cell.corner, u, v, cell.triangle}, Cell{cell.corner + u, u, v, cell.triangle},
            Cell{cell.corner + v, u, v, cell.triangle},
            cell.triangle ? Cell{cell.corner + u + v, -u, -v, true} : Cell{cell.corner + u + v, u, v, false}};
  }

  /// The integral over a cell by 2 x 2 Gauss points, or by three of a triangle (Strang & Fix 1973).
  bool by_rule(const Cell& cell, double& integral) {
    constexpr double kLow = 0.5 - 0.5 * std::numbers::inv_sqrt3, kHigh = 1 - kLow;
    constexpr std::array<std::pair<double, double>, 4> kSquare{
        {{kLow, kLow}, {kHigh, kLow}, {kLow, kHigh}, {kHigh, kHigh}}};
    constexpr std::array<std::pair<double, double>, 3> kTriangle{
        {{1.0 / 6, 1.0 / 6}, {2.0 / 3, 1.0 / 6}, {1.0 / 6, 2.0 / 3}}};
    const std::span<const std::pair<double, double>> points =
        cell.triangle ? std::span<const std::pair<double, double>>(kTriangle)
                      : std::span<const std::pair<double, double>>(kSquare);
    double sum = 0;
    for (const auto& [s, t] : points) {
      double factor = 0;
      if (!visible_factor(cell.corner + s * cell.u + t * cell.v, factor)) return false;
      sum += factor;
    }
    integral = area_of(cell) * sum / static_cast<double>(points.size());
    return true;
  }

  bool refine(const Cell& cell, double whole, double tolerance, int quarterings, double& sum,
              double& variance) {
    const std::array<Cell, 4> parts = quarters(cell);
    std::array<double, 4> of_parts;
    double total = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      if (!by_rule(parts[k], of_parts[k])) return false;
      total += of_parts[k];
    }
    const double change = caution() * std::abs(total - whole);
    if (change <= tolerance || quarterings >= kMaxQuarterings) {
      sum += total;
      variance += change * change;
      return true;
    }
    for (std::size_t k = 0; k < 4; ++k)
      if (!refine(parts[k], of_parts[k], tolerance / 2, quarterings + 1, sum, variance)) return false;
    return true;
  }

  /// Errors of cells and pairs are taken for independent. Behind rows of equal occluders, such as slats, all
  /// have one sign.
  [[nodiscard]] double caution() const {
    constexpr std::size_t kFew = 4;
    constexpr double kOfRows = 8;
    return occluders_.size() > kFew ? kOfRows : 1;
  }

  /// The factor of a point towards what it sees of the receiving polygon; false where there are too many
  /// parts.
  bool visible_factor(const glm::dvec3& x, double& factor) {
    parts_.assign(1, whole_);
    const glm::dvec3 lifted = x + lift_ * normal_;
    for (const FlatOccluder& occluder : occluders_) {
      if (!shadow_of(occluder, lifted)) continue;
      if (!take_shadow()) return false;
      if (parts_.empty()) return true;
    }
    for (const Part& part : parts_) factor += factor_of(part, x);
    return true;
  }

  /// Lambert's formula, of a part in front of the point's plane.
  [[nodiscard]] double factor_of(const Part& part, const glm::dvec3& x) const {
    double sum = 0;
    glm::dvec3 a(part.back().x - x.x, part.back().y - x.y, -x.z);
    for (const glm::dvec2& corner : part) {
      const glm::dvec3 b(corner.x - x.x, corner.y - x.y, -x.z);
      const glm::dvec3 across = glm::cross(a, b);
      const double sine = glm::length(across);
      if (sine > 0) sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(normal_, across) / sine;
      a = b;
    }
    return std::abs(sum) / (2 * std::numbers::pi);
  }

  /// The shadow in the receiving plane: between the planes through the point and the occluder's edges, and
  /// beyond the occluder's own plane. False where there is none.
  bool shadow_of(const FlatOccluder& occluder, const glm::dvec3& x) {
    const double height = glm::dot(occluder.normal, occluder.corners[0] - x);
    if (std::abs(height) <= lift_ * 1e-3) return false;  // seen from its edge
    const double sign = height > 0 ? 1 : -1;
    shadow_.clear();
    const auto add = [&](const glm::dvec3& normal, double constant) {
      const double length = glm::length(glm::dvec2(normal));
      if (length <= 1e-12 * glm::length(normal)) return constant > 0;
      shadow_.push_back({normal.x / length, normal.y / length, constant / length});
      return true;
    };
    const glm::dvec3 beyond = sign * occluder.normal;
    if (!add(beyond, beyond.z * lift_ - glm::dot(beyond, occluder.corners[0]))) return false;
    glm::dvec3 from = occluder.corners.back() - x;
    for (const glm::dvec3& corner : occluder.corners) {
      const glm::dvec3 to = corner - x;
      const glm::dvec3 inward = sign * glm::cross(from, to);
      if (!add(inward, inward.z * lift_ - glm::dot(inward, x))) return false;
      from = to;
    }
    return true;
  }

  /// Takes the shadow from all parts; false where more remain than are kept.
  bool take_shadow() {
    left_.clear();
    for (const Part& part : parts_)
      if (!add_lit(part)) return false;
    std::swap(parts_, left_);
    return true;
  }

  bool add_lit(const Part& part) {
    const std::size_t before = left_.size();
    in_ = part;
    for (const Line& line : shadow_) {
      std::array<double, kMaxPartCorners> heights;
      double least = 0, most = 0;
      for (std::size_t k = 0; k < in_.size(); ++k) {
        const double h = line.a * in_[k].x + line.b * in_[k].y + line.c;
        heights[k] = std::abs(h) <= lift_ ? 0.0 : h;
        least = std::min(least, heights[k]);
        most = std::max(most, heights[k]);
      }
      if (most == 0) {  // all of it is lit: what was cut off belongs together
        left_.resize(before);
        if (left_.size() == kMaxLitParts) return false;
        left_.push_back(part);
        return true;
      }
      if (least == 0) continue;
      if (left_.size() == kMaxLitParts || in_.size() + 2 > kMaxPartCorners) return false;
      left_.emplace_back();
      cut(in_, heights, still_in_, left_.back());
      std::swap(in_, still_in_);
    }
    return true;
  }

  double lift_;
  glm::dvec3 origin_, axis_x_, axis_y_{0}, axis_z_;
  glm::dvec3 normal_{0};  // of the sending polygon
  Part whole_;
  boost::container::static_vector<FlatOccluder, kMaxShadows> occluders_;
  boost::container::small_vector<Cell, 6> cells_;
  Shadow shadow_;
  Parts parts_, left_;
  Part in_, still_in_;
};

double radius(const SmallPolygon& polygon) {
  const glm::dvec3 centre = centroid(corners(polygon));
  double most = 0;
  for (const glm::dvec3& corner : polygon) most = std::max(most, glm::distance(corner, centre));
  return most;
}

/// Whether the shadows of points of P move less over Q, in sizes of Q, than those of points of Q over P.
bool moves_least_from_first(const SampledPolygon& P, const SampledPolygon& Q,
                            std::span<const PolygonView> occluders) {
  const glm::dvec3 from = centroid(corners(P.corners)), along = centroid(corners(Q.corners)) - from;
  double place = 0;
  for (const PolygonView occluder : occluders)
    place += std::clamp(glm::dot(centroid(occluder) - from, along) / glm::dot(along, along), 0.0, 1.0);
  place /= static_cast<double>(occluders.size());
  return radius(P.corners) * (1 - place) <= radius(Q.corners) * place;
}

}  // namespace

std::optional<ShadowedArea> shadowed_exchange(const SampledPolygon& P, const SampledPolygon& Q,
                                              std::span<const PolygonView> occluders, double lift,
                                              double tolerance) {
  if (occluders.size() > kMaxShadows) return std::nullopt;
  const bool from_P = moves_least_from_first(P, Q, occluders);
  ShadowIntegral integral(from_P ? P : Q, from_P ? Q : P, occluders, lift);
  ShadowedArea found;
  if (!integral.integrate(tolerance, found)) return std::nullopt;
  return found;
}

}  // namespace fluxel
