#pragma once

// What finders of a point's outline share; for .cpp files of this folder.

#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/iterator/function_output_iterator.hpp>
#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <utility>
#include <vector>

#include "core/element.hpp"

namespace fluxel {

/// Boxes around outlines, by their numbers.
class BoxIndex {
 public:
  using Point = boost::geometry::model::point<double, 3, boost::geometry::cs::cartesian>;
  using Box = boost::geometry::model::box<Point>;
  using Entry = std::pair<Box, std::uint32_t>;

  BoxIndex() = default;
  explicit BoxIndex(const std::vector<Entry>& entries) : boxes_(entries) {}

  /// `margin` [m] on all sides.
  template <class Vec>
  [[nodiscard]] static Entry entry(const Outline<Vec>& outline, double margin, std::uint32_t number) {
    glm::dvec3 low(outline.corner[0]), high = low;
    for (std::size_t k = 1; k < outline.corners; ++k) {
      low = glm::min(low, glm::dvec3(outline.corner[k]));
      high = glm::max(high, glm::dvec3(outline.corner[k]));
    }
    return {Box(to_point(low - margin), to_point(high + margin)), number};
  }

  /// Calls `visit` with the number of each box that holds the point, in any order.
  template <class Visit>
  void visit_around(const glm::dvec3& point, const Visit& visit) const {
    const Box box(to_point(point), to_point(point));
    const auto take = [&visit](const Entry& entry) { visit(entry.second); };
    boxes_.query(boost::geometry::index::intersects(box), boost::make_function_output_iterator(take));
  }

 private:
  static Point to_point(const glm::dvec3& x) { return {x.x, x.y, x.z}; }

  boost::geometry::index::rtree<Entry, boost::geometry::index::linear<16>> boxes_;
};

/// A patch of more outlines is looked up by their boxes.
inline constexpr std::size_t kFewOutlines = 8;

}  // namespace fluxel
