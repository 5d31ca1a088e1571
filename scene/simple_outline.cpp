#include "scene/simple_outline.hpp"

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <glm/geometric.hpp>

namespace fluxel {
namespace {

double distance_from_segment(const glm::dvec3& x, const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 along = to - from;
  const double square = glm::dot(along, along);
  const double t = square > 0 ? std::clamp(glm::dot(x - from, along) / square, 0.0, 1.0) : 0.0;
  return glm::distance(x, from + t * along);
}

/// The closed line's corners, by their numbers in it.
class LoopCorners {
 public:
  LoopCorners(std::span<const std::uint32_t> loop, std::span<const glm::dvec3> places)
      : loop_(loop), places_(places) {
    // What is farthest from anywhere is a corner.
    const std::size_t first = farthest_from(point(0)), second = farthest_from(point(first));
    found_ = {std::min(first, second), std::max(first, second)};
  }

  /// Adds corners until the rest lies within `tolerance`; false where four do not suffice.
  bool complete(double tolerance) {
    for (std::size_t k = 0; k < found_.size();) {
      const std::size_t from = found_[k], to = found_[(k + 1) % found_.size()];
      std::size_t worst = from;
      double most = 0;
      for (std::size_t i = next(from); i != to; i = next(i)) {
        const double distance = distance_from_segment(point(i), point(from), point(to));
        if (distance > most) {
          most = distance;
          worst = i;
        }
      }
      if (most <= tolerance) {
        deviation_ = std::max(deviation_, most);
        ++k;
      } else if (found_.size() == 4) {
        return false;
      } else {
        // Behind the last corner the line goes on at its beginning.
        found_.insert(std::ranges::upper_bound(found_, worst), worst);
        k = 0;
        deviation_ = 0;
      }
    }
    return found_.size() >= 3;
  }

  [[nodiscard]] double deviation() const { return deviation_; }
  [[nodiscard]] double diameter() const { return glm::distance(point(found_[0]), point(found_[1])); }

  [[nodiscard]] Outline<std::uint32_t> outline() const {
    Outline<std::uint32_t> outline;
    for (const std::size_t i : found_) outline.corner[outline.corners++] = loop_[i];
    return outline;
  }

 private:
  [[nodiscard]] std::size_t next(std::size_t i) const { return i + 1 == loop_.size() ? 0 : i + 1; }
  [[nodiscard]] const glm::dvec3& point(std::size_t i) const { return places_[loop_[i]]; }

  [[nodiscard]] std::size_t farthest_from(const glm::dvec3& x) const {
    std::size_t farthest = 0;
    double most = 0;
    for (std::size_t i = 0; i < loop_.size(); ++i) {
      const double distance = glm::distance(point(i), x);
      if (distance > most) {
        most = distance;
        farthest = i;
      }
    }
    return farthest;
  }

  std::span<const std::uint32_t> loop_;
  std::span<const glm::dvec3> places_;
  boost::container::static_vector<std::size_t, 4> found_;  // ascending
  double deviation_ = 0;
};

}  // namespace

std::optional<SimpleOutline> simple_outline(std::span<const std::uint32_t> loop,
                                            std::span<const glm::dvec3> places, double before,
                                            const MergeTolerance& tolerance) {
  LoopCorners corners(loop, places);
  // The longest edge of a triangle or a parallelogram is at least that long.
  const double allowed = tolerance.outline(0.5 * corners.diameter());
  if (before > allowed || !corners.complete(allowed - before)) return std::nullopt;
  const Outline<std::uint32_t> outline = corners.outline();
  const auto point = [&](std::size_t i) { return places[outline.corner[i]]; };
  if (outline.corners == 4 && glm::distance(point(0) + point(2), point(1) + point(3)) > allowed)
    return std::nullopt;
  return SimpleOutline{outline, before + corners.deviation()};
}

}  // namespace fluxel
