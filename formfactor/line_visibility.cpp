#include "formfactor/line_visibility.hpp"

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "formfactor/even_points.hpp"
#include "scene/polygon.hpp"

namespace fluxel {

namespace {

/// Shadows of what is nearer to the point than this, over the point's height, reach beyond every chord.
constexpr double kLeastDepth = 1e-9;

constexpr std::uint64_t kFirstLines = 2, kMostLines = std::uint64_t{1} << 16;

/// From and to along a line.
using Interval = std::pair<double, double>;

/// A line of polygon Q seen from a point: y(l) = foot + l * along.
struct SeenLine {
  glm::dvec3 point;        // of P
  glm::dvec3 foot, along;  // along is of unit length
  double height;           // of the point over Q's plane
};

class LineSequence {
 public:
  LineSequence(const SampledPolygon& P, const SampledPolygon& Q, std::span<const Outline<glm::dvec3>> between,
               std::uint64_t seed)
      : P_(P), Q_(Q), between_(between), fan_(P.corners), places_(seed) {
    // Another direction for each sequence, so that edges parallel to the lines spoil few of them.
    const glm::dvec3 u = glm::normalize(Q.corners[1] - Q.corners[0]);
    const double angle = std::numbers::pi * static_cast<double>(mix(~seed) >> 11) * 0x1p-53;
    along_ = std::cos(angle) * u + std::sin(angle) * glm::cross(Q.normal, u);
    across_ = glm::cross(Q.normal, along_);
    low_ = high_ = glm::dot(across_, Q.corners[0]);
    for (const glm::dvec3& corner : Q.corners) {
      low_ = std::min(low_, glm::dot(across_, corner));
      high_ = std::max(high_, glm::dot(across_, corner));
    }
  }

  void sample() {
    ++samples_;
    const auto [u, v, t] = places_.next();
    const glm::dvec3 point = fan_.point(u, v);
    const std::optional<Interval> chord = chord_at(low_ + t * (high_ - low_));
    if (!chord) return;
    const SeenLine line{point, foot_, along_, glm::dot(Q_.normal, point - Q_.corners[0])};
    if (!(line.height > 0)) return;
    find_shadows(line, *chord);
    all_ += power(line, *chord);
    double from = chord->first;
    for (const Interval& shadow : shadows_) {
      if (shadow.first > from) seen_ += power(line, {from, shadow.first});
      from = std::max(from, shadow.second);
    }
    if (from < chord->second) seen_ += power(line, {from, chord->second});
    shadowed_ = shadowed_ || !shadows_.empty();
  }

  [[nodiscard]] std::uint64_t samples() const { return samples_; }
  [[nodiscard]] bool agree() const { return seen_ == 0 || !shadowed_; }
  [[nodiscard]] double visible() const {
    return !shadowed_ ? 1.0 : all_ > 0 ? std::min(1.0, seen_ / all_) : 0.0;
  }

 private:
  /// Where the line at that place across Q lies in Q; foot_ becomes a point of it.
  std::optional<Interval> chord_at(double place) {
    std::array<glm::dvec3, 2> ends;
    std::size_t count = 0;
    for (std::size_t k = 0; k < Q_.corners.size() && count < 2; ++k) {
      const glm::dvec3 &a = Q_.corners[k], &b = Q_.corners[(k + 1) % Q_.corners.size()];
      const double height_a = glm::dot(across_, a) - place, height_b = glm::dot(across_, b) - place;
      if ((height_a < 0) != (height_b < 0)) ends[count++] = a + height_a / (height_a - height_b) * (b - a);
    }
    if (count < 2) return std::nullopt;
    foot_ = ends[0];
    const double length = glm::dot(along_, ends[1] - ends[0]);
    return length < 0 ? Interval{length, 0} : Interval{0, length};
  }

  /// The intervals of the chord that the patches hide, by their beginnings.
  void find_shadows(const SeenLine& line, const Interval& chord) {
    shadows_.clear();
    const glm::dvec3 plane = glm::cross(line.along, line.foot - line.point);
    for (const Outline<glm::dvec3>& patch : between_) {
      const std::optional<Interval> shadow = shadow_of(line, plane, patch);
      if (!shadow || shadow->second <= chord.first || shadow->first >= chord.second) continue;
      shadows_.emplace_back(std::max(shadow->first, chord.first), std::min(shadow->second, chord.second));
    }
    std::sort(shadows_.begin(), shadows_.end());
  }

  /// The patch's cut with the plane through point and line, thrown from the point on the line.
  std::optional<Interval> shadow_of(const SeenLine& line, const glm::dvec3& plane,
                                    const Outline<glm::dvec3>& patch) const {
    std::array<glm::dvec3, 2> ends;
    std::size_t count = 0;
    for (std::size_t k = 0; k < patch.corners && count < 2; ++k) {
      const glm::dvec3 a = patch.corner[k] - line.point,
                       b = patch.corner[(k + 1) % patch.corners] - line.point;
      const double side_a = glm::dot(plane, a), side_b = glm::dot(plane, b);
      if ((side_a < 0) != (side_b < 0)) ends[count++] = a + side_a / (side_a - side_b) * (b - a);
    }
    if (count < 2) return std::nullopt;
    // Only what lies between the point and Q's plane hides: depths from 0 to the height.
    if (glm::dot(Q_.normal, ends[0] - ends[1]) < 0) std::swap(ends[0], ends[1]);
    const double least = kLeastDepth * line.height;
    double depth_0 = -glm::dot(Q_.normal, ends[0]), depth_1 = -glm::dot(Q_.normal, ends[1]);
    if (depth_1 <= least || depth_0 >= line.height) return std::nullopt;
    const glm::dvec3 slope = (ends[1] - ends[0]) / (depth_1 - depth_0);
    if (depth_0 < least) ends[0] += (least - std::exchange(depth_0, least)) * slope;
    if (depth_1 > line.height) ends[1] += (line.height - std::exchange(depth_1, line.height)) * slope;
    const auto thrown = [&](const glm::dvec3& end, double depth) {
      return glm::dot(line.along, line.point + line.height / depth * end - line.foot);
    };
    const double l0 = thrown(ends[0], depth_0), l1 = thrown(ends[1], depth_1);
    return std::minmax(l0, l1);
  }

  /// The kernel integrated over a stretch of the line, but for constant factors.
  [[nodiscard]] double power(const SeenLine& line, const Interval& stretch) const {
    return boost::math::quadrature::gauss<double, 7>::integrate(
               [&](double l) {
                 const glm::dvec3 d = line.foot + l * line.along - line.point;
                 const double r2 = glm::dot(d, d);
                 return glm::dot(P_.normal, d) / (r2 * r2);
               },
               stretch.first, stretch.second) *
           line.height;
  }

  const SampledPolygon &P_, &Q_;
  std::span<const Outline<glm::dvec3>> between_;
  PolygonFan fan_;
  EvenSequence<3> places_;
  glm::dvec3 along_, across_, foot_{0};
  double low_, high_;
  std::vector<Interval> shadows_;
  double all_ = 0, seen_ = 0;
  bool shadowed_ = false;
  std::uint64_t samples_ = 0;
};

}  // namespace

FractionEstimate visible_fraction_by_lines(const SampledPolygon& P, const SampledPolygon& Q,
                                           std::span<const Outline<glm::dvec3>> between, std::uint64_t seed,
                                           double wanted) {
  const auto sequence = [&](std::uint64_t k) { return LineSequence(P, Q, between, kSequences * seed + k); };
  std::array<LineSequence, kSequences> sequences{sequence(0), sequence(1), sequence(2), sequence(3),
                                                 sequence(4), sequence(5), sequence(6), sequence(7)};
  return estimate(sequences, kFirstLines, wanted, kMostLines * kSequences);
}

}  // namespace fluxel
