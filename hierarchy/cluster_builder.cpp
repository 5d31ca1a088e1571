#include "hierarchy/cluster_builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <numeric>

#include "visibility/shaft.hpp"

namespace fluxel {

namespace {

constexpr std::size_t kBins = 12;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What the heuristic asks of a set of faces.
struct Bundle {
  Box box{glm::dvec3(kInfinity), glm::dvec3(-kInfinity)};
  Cone cone;
  double area = 0;

  void add(const Bundle& other) {
    if (other.area == 0) return;
    cone = area == 0 ? other.cone : unite(cone, other.cone);
    box.low = glm::min(box.low, other.box.low);
    box.high = glm::max(box.high, other.box.high);
    area += other.area;
  }

  [[nodiscard]] double cost() const {
    if (area == 0) return 0;
    const glm::dvec3 d = box.high - box.low;
    const double surface = d.x * d.y + d.y * d.z + d.z * d.x;
    const double t = cone.half_angle, w = std::min(std::numbers::pi, t + std::numbers::pi / 2);
    const double directions =
        2 * std::numbers::pi * (1 - std::cos(t)) +
        std::numbers::pi / 2 *
            (2 * w * std::sin(t) - std::cos(t - 2 * w) - 2 * t * std::sin(t) + std::cos(t));
    return area * surface * directions;
  }
};

Bundle bundle_of(const Node& face) {
  const glm::dvec3 reach(face.radius);
  return {
      {face.shape.centroid - reach, face.shape.centroid + reach}, {face.shape.normal, 0}, face.shape.area};
}

class Builder {
 public:
  explicit Builder(std::span<const Node> faces) : faces_(faces), ids_(faces.size()) {
    std::iota(ids_.begin(), ids_.end(), std::uint32_t{0});
  }

  ClusterTree build() {
    if (faces_.size() > 1) {
      struct Open {
        std::size_t first, last, cluster;
      };
      std::vector<Open> open{{0, faces_.size(), 0}};
      tree_.clusters.emplace_back();
      while (!open.empty()) {
        const Open now = open.back();
        open.pop_back();
        const std::size_t middle = divide(now.first, now.last, tree_.clusters[now.cluster].cone);
        const std::array<std::pair<std::size_t, std::size_t>, 2> halves{
            {{now.first, middle}, {middle, now.last}}};
        for (std::size_t k = 0; k < 2; ++k) {
          const auto [first, last] = halves[k];
          if (last - first == 1) {
            tree_.clusters[now.cluster].child[k] = ClusterTree::kFace + ids_[first];
            continue;
          }
          tree_.clusters[now.cluster].child[k] = static_cast<std::uint32_t>(tree_.clusters.size());
          open.push_back({first, last, tree_.clusters.size()});
          tree_.clusters.emplace_back();
        }
      }
    }
    return std::move(tree_);
  }

 private:
  /// Orders ids_[first, last) so that the halves stand on either side of the place that is given back.
  std::size_t divide(std::size_t first, std::size_t last, Cone& cone) {
    Bundle all;
    Box centroids{glm::dvec3(kInfinity), glm::dvec3(-kInfinity)};
    for (std::size_t k = first; k < last; ++k) {
      all.add(bundle_of(faces_[ids_[k]]));
      centroids.low = glm::min(centroids.low, faces_[ids_[k]].shape.centroid);
      centroids.high = glm::max(centroids.high, faces_[ids_[k]].shape.centroid);
    }
    cone = all.cone;
    if (const std::size_t backs = part_sides(first, last); backs != first && backs != last) return backs;
    double best = kInfinity;
    int best_axis = -1;
    std::size_t best_bin = 0;
    const auto bin_of = [&](std::uint32_t id, int axis) {
      const double width = centroids.high[axis] - centroids.low[axis];
      const double at = (faces_[id].shape.centroid[axis] - centroids.low[axis]) / width;
      return std::min(kBins - 1, static_cast<std::size_t>(at * kBins));
    };
    for (int axis = 0; axis < 3; ++axis) {
      if (!(centroids.high[axis] > centroids.low[axis])) continue;
      std::array<Bundle, kBins> bins;
      for (std::size_t k = first; k < last; ++k) bins[bin_of(ids_[k], axis)].add(bundle_of(faces_[ids_[k]]));
      std::array<double, kBins> after{};
      Bundle sum;
      for (std::size_t bin = kBins - 1; bin > 0; --bin) {
        sum.add(bins[bin]);
        after[bin] = sum.area == 0 ? kInfinity : sum.cost();
      }
      sum = {};
      for (std::size_t bin = 0; bin + 1 < kBins; ++bin) {
        sum.add(bins[bin]);
        if (sum.area == 0) continue;
        if (const double cost = sum.cost() + after[bin + 1]; cost < best) {
          best = cost;
          best_axis = axis;
          best_bin = bin;
        }
      }
    }
    if (best_axis < 0) return first + (last - first) / 2;  // all centroids are one point
    const auto middle = std::stable_partition(
        ids_.begin() + static_cast<std::ptrdiff_t>(first), ids_.begin() + static_cast<std::ptrdiff_t>(last),
        [&](std::uint32_t id) { return bin_of(id, best_axis) <= best_bin; });
    return static_cast<std::size_t>(middle - ids_.begin());
  }

  /// Fronts and backs lie at the same places, but in different light: inside and outside of a post. Puts the
  /// fronts first.
  std::size_t part_sides(std::size_t first, std::size_t last) {
    const auto backs = std::stable_partition(ids_.begin() + static_cast<std::ptrdiff_t>(first),
                                             ids_.begin() + static_cast<std::ptrdiff_t>(last),
                                             [&](std::uint32_t id) { return faces_[id].front; });
    return static_cast<std::size_t>(backs - ids_.begin());
  }

  std::span<const Node> faces_;
  std::vector<std::uint32_t> ids_;
  ClusterTree tree_;
};

}  // namespace

Cone unite(const Cone& a, const Cone& b) {
  const bool a_wider = a.half_angle >= b.half_angle;
  const Cone &wide = a_wider ? a : b, &narrow = a_wider ? b : a;
  const double cosine = std::clamp(glm::dot(wide.axis, narrow.axis), -1.0, 1.0);
  const double between = std::acos(cosine);
  if (between + narrow.half_angle <= wide.half_angle) return wide;
  const double half_angle = 0.5 * (wide.half_angle + between + narrow.half_angle);
  const glm::dvec3 across = narrow.axis - cosine * wide.axis;
  const double length = glm::length(across);
  if (half_angle >= std::numbers::pi || !(length > 0)) return {wide.axis, std::numbers::pi};
  // Turned towards the narrow one.
  const double turn = half_angle - wide.half_angle;
  return {glm::normalize(std::cos(turn) * wide.axis + std::sin(turn) / length * across), half_angle};
}

ClusterTree build_cluster_tree(std::span<const Node> faces) { return Builder(faces).build(); }

}  // namespace fluxel
