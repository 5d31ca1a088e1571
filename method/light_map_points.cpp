#include "method/light_map_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <unordered_map>

#include "core/hash.hpp"
#include "scene/polygon.hpp"

namespace fluxel {

namespace {

/// Of the shorter step of a lattice: how far within the outline of its piece a texel is looked at.
constexpr double kInside = 0.1;

/// Of the shorter step: on an outline rather than beside it.
constexpr double kOnOutline = 1e-5;

/// Of the shorter step: how high above the surface it is asked what stands between two texels.
constexpr double kHigh = 0.5;

using MapTexel = std::array<std::int64_t, 3>;  // lattice, column, row

struct HashTexel {
  std::size_t operator()(const MapTexel& texel) const { return hash_bytes(std::as_bytes(std::span(texel))); }
};

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// The part of a convex polygon on one side of a line; `inward` is unit.
std::vector<glm::dvec2> clipped(const std::vector<glm::dvec2>& polygon, const glm::dvec2& on_line,
                                const glm::dvec2& inward) {
  std::vector<glm::dvec2> kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const glm::dvec2 &from = polygon[k], &to = polygon[(k + 1) % polygon.size()];
    const double before = glm::dot(from - on_line, inward), after = glm::dot(to - on_line, inward);
    if (before >= 0) kept.push_back(from);
    if ((before >= 0) != (after >= 0)) kept.push_back(from + before / (before - after) * (to - from));
  }
  return kept;
}

/// A piece along the axes of its lattice [m].
class FlatPiece {
 public:
  FlatPiece(const Outline<glm::dvec3>& outline, const TexelLattice& lattice) {
    for (const glm::dvec3& corner : corners(outline)) outline_.push_back(lattice.along_axes(corner));
    double area = 0, around = 0;
    for (std::size_t k = 0; k < outline_.size(); ++k) {
      area += 0.5 * cross(outline_[k], next(k));
      around += glm::distance(outline_[k], next(k));
    }
    // A convex polygon holds a circle of its area over its perimeter.
    const double inset =
        std::min(kInside * std::min(lattice.step.x, lattice.step.y), 0.5 * std::abs(area) / around);
    inside_ = outline_;
    for (std::size_t k = 0; k < outline_.size(); ++k) {
      const glm::dvec2 way = next(k) - outline_[k];
      inward_.push_back((area > 0 ? 1 : -1) / glm::length(way) * glm::dvec2(-way.y, way.x));
      inside_ = clipped(inside_, outline_[k] + inset * inward_[k], inward_[k]);
    }
  }

  /// How far inside of all edges [m]; below 0 beside the piece.
  [[nodiscard]] double depth(const glm::dvec2& at) const {
    double least = std::numeric_limits<double>::max();
    for (std::size_t k = 0; k < outline_.size(); ++k)
      least = std::min(least, glm::dot(at - outline_[k], inward_[k]));
    return least;
  }

  /// The nearest place that is a little inside.
  [[nodiscard]] glm::dvec2 held_inside(const glm::dvec2& at) const {
    glm::dvec2 best = at;
    double least = std::numeric_limits<double>::max();
    bool is_inside = true;
    for (std::size_t k = 0; k < inside_.size(); ++k) {
      const glm::dvec2 &from = inside_[k], way = inside_[(k + 1) % inside_.size()] - from;
      const double squared = glm::dot(way, way);
      if (!(squared > 0)) continue;
      is_inside = is_inside &&
                  cross(way, at - from) * cross(outline_[1] - outline_[0], outline_[2] - outline_[1]) >= 0;
      const glm::dvec2 place = from + std::clamp(glm::dot(at - from, way) / squared, 0.0, 1.0) * way;
      if (const double distance = glm::distance(at, place); distance < least) least = distance, best = place;
    }
    return is_inside ? at : best;
  }

 private:
  [[nodiscard]] const glm::dvec2& next(std::size_t k) const { return outline_[(k + 1) % outline_.size()]; }

  std::vector<glm::dvec2> outline_, inside_, inward_;  // inside_: less a margin
};

/// A chart's texel.
struct ChartTexel {
  std::uint32_t chart = 0;
  glm::ivec2 at{0};        ///< column and row of the chart
  glm::dvec3 position{0};  ///< of its piece
};

class PointMaker {
 public:
  PointMaker(const LightMapLayout& layout, const NodeTree& tree, const RayScene& ray_scene)
      : layout_(layout), tree_(tree), ray_scene_(ray_scene) {
    const std::size_t texels =
        static_cast<std::size_t>(layout.width) * static_cast<std::size_t>(layout.height);
    made_.chart.assign(texels, LightMap::kNone);
    made_.point.assign(texels, LightMap::kNone);
  }

  [[nodiscard]] LightMapPoints make() && {
    for (std::uint32_t chart = 0; chart < layout_.charts.size(); ++chart) look_at(chart);
    std::vector<ChartTexel> hidden;
    for (const ChartTexel& texel : beside_)
      if (!take_from_neighbour(texel)) hidden.push_back(texel);
    std::vector<std::uint32_t> points;
    points.reserve(hidden.size());
    for (const ChartTexel& texel : hidden) points.push_back(point_beside(texel));
    for (std::size_t k = 0; k < hidden.size(); ++k) set(hidden[k], points[k]);
    return std::move(made_);
  }

 private:
  /// A chart's point at a texel of a lattice, for others to take.
  struct Known {
    std::uint32_t point = 0, chart = 0;
    bool inside = false;  ///< of the chart's own piece
  };

  /// The texels of a piece itself.
  void look_at(std::uint32_t number) {
    const LightMapChart& chart = layout_.charts[number];
    const TexelLattice& lattice = layout_.lattices[chart.lattice];
    const FlatPiece piece(tree_.scene().pieces[chart.piece].outline, lattice);
    const double shorter = std::min(lattice.step.x, lattice.step.y), reach = glm::length(lattice.step);
    for (ChartTexel texel{number}; texel.at.y < chart.texels.y; ++texel.at.y)
      for (texel.at.x = 0; texel.at.x < chart.texels.x; ++texel.at.x) {
        const glm::dvec2 at = glm::dvec2(chart.first + glm::i64vec2(texel.at)) * lattice.step;
        const double depth = piece.depth(at);
        if (depth < -reach) continue;
        texel.position = lattice.point(piece.held_inside(at));
        if (depth < -kOnOutline * shorter) {
          beside_.push_back(texel);
        } else if (depth > reach) {
          set(texel, new_point(texel));  // which no other chart asks for
        } else if (!take_from_neighbour(texel)) {
          set(texel, new_point(texel));
          known_[key(texel)].push_back({point_of(texel), number, true});
        }
      }
  }

  /// Takes the light that another piece has there, if it has.
  bool take_from_neighbour(const ChartTexel& texel) {
    const auto known = known_.find(key(texel));
    if (known == known_.end()) return false;
    for (const Known& other : known->second)
      if (other.inside && is_open(texel, other)) {
        set(texel, other.point);
        known->second.push_back({other.point, texel.chart, false});
        return true;
      }
    return false;
  }

  /// Of a texel that lies on no piece, or behind what stands on the surface. Of charts that are continuous
  /// right beside it the first one says, so that no seam ends there; where nothing is open, nothing is
  /// shared.
  std::uint32_t point_beside(const ChartTexel& texel) {
    std::vector<Known>& known = known_[key(texel)];
    const auto other = std::ranges::find_if(known, [&](const Known& of) {
      return have_common_neighbour(texel, of) || (!of.inside && is_open(texel, of));
    });
    const std::uint32_t point = other != known.end() ? other->point : new_point(texel);
    known.push_back({point, texel.chart, false});
    return point;
  }

  std::uint32_t new_point(const ChartTexel& texel) {
    const LightMapChart& chart = layout_.charts[texel.chart];
    made_.points.push_back({tree_.face(chart.piece, chart.front), texel.position});
    made_.texel.push_back(static_cast<std::uint32_t>(in_map(texel.chart, texel.at)));
    return static_cast<std::uint32_t>(made_.points.size() - 1);
  }

  [[nodiscard]] std::size_t in_map(std::uint32_t chart, const glm::ivec2& at) const {
    const glm::ivec2 place = layout_.charts[chart].place + at;
    return static_cast<std::size_t>(place.y) * static_cast<std::size_t>(layout_.width) +
           static_cast<std::size_t>(place.x);
  }
  [[nodiscard]] std::uint32_t point_of(const ChartTexel& texel) const {
    return made_.point[in_map(texel.chart, texel.at)];
  }
  void set(const ChartTexel& texel, std::uint32_t point) {
    const std::size_t place = in_map(texel.chart, texel.at);
    made_.chart[place] = texel.chart;
    made_.point[place] = point;
  }
  [[nodiscard]] MapTexel key(const ChartTexel& texel) const {
    const LightMapChart& chart = layout_.charts[texel.chart];
    return {chart.lattice, chart.first.x + texel.at.x, chart.first.y + texel.at.y};
  }

  /// Of a chart at a texel of its lattice; none outside.
  [[nodiscard]] std::uint32_t point_at(std::uint32_t number, const glm::i64vec2& of_lattice) const {
    const LightMapChart& chart = layout_.charts[number];
    const glm::i64vec2 at = of_lattice - chart.first;
    if (at.x < 0 || at.y < 0 || at.x >= chart.texels.x || at.y >= chart.texels.y) return LightMap::kNone;
    return made_.point[in_map(number, glm::ivec2(at))];
  }

  /// Whether two charts show the same light at one of the eight texels around.
  [[nodiscard]] bool have_common_neighbour(const ChartTexel& texel, const Known& other) const {
    const glm::i64vec2 middle = layout_.charts[texel.chart].first + glm::i64vec2(texel.at);
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const std::uint32_t point = point_at(texel.chart, middle + glm::i64vec2(x, y));
        if (point != LightMap::kNone && point == point_at(other.chart, middle + glm::i64vec2(x, y)))
          return true;
      }
    return false;
  }

  /// Whether nothing stands on the surface, or lies or ends closely above it, between a texel's place and
  /// another's.
  [[nodiscard]] bool is_open(const ChartTexel& texel, const Known& other) const {
    const TexelLattice& lattice = layout_.lattices[layout_.charts[texel.chart].lattice];
    const glm::dvec3 low = least_gap_ * lattice.normal,
                     high = std::max(kHigh * std::min(lattice.step.x, lattice.step.y), least_gap_) *
                            lattice.normal;
    const glm::dvec3 &from = texel.position, &to = made_.points[other.point].position;
    RayPacket packet{};
    packet.set_segment(0, glm::vec3(from + low), glm::vec3(to + low));
    packet.set_segment(1, glm::vec3(from + low), glm::vec3(to + high));
    packet.set_segment(2, glm::vec3(from + high), glm::vec3(to + low));
    return ray_scene_.occluded(packet, 3) == 0;
  }

  const LightMapLayout& layout_;
  const NodeTree& tree_;
  const RayScene& ray_scene_;
  double least_gap_ = least_gap(ray_scene_.scene());
  LightMapPoints made_;
  std::vector<ChartTexel> beside_;
  std::unordered_map<MapTexel, std::vector<Known>, HashTexel> known_;
};

}  // namespace

LightMapPoints points_of(const LightMapLayout& layout, const NodeTree& tree, const RayScene& ray_scene) {
  return PointMaker(layout, tree, ray_scene).make();
}

}  // namespace fluxel
