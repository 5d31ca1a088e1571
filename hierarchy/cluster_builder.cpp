#include "hierarchy/cluster_builder.hpp"

#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <utility>

#include "visibility/shaft.hpp"

namespace fluxel {

namespace {

constexpr std::size_t kBins = 12;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Faces from which on both halves are built at once.
constexpr std::size_t kApart = 4096;

struct Face {
  glm::dvec3 centroid;
  double radius;
  glm::dvec3 normal;
  double area;
  std::uint32_t number;
  bool front;
};

/// What the heuristic asks of a set of faces.
struct Bundle {
  Box box{glm::dvec3(kInfinity), glm::dvec3(-kInfinity)};
  glm::dvec3 normals{0};  ///< times areas
  double area = 0;

  void add(const Face& face) {
    box.low = glm::min(box.low, face.centroid - face.radius);
    box.high = glm::max(box.high, face.centroid + face.radius);
    normals += face.area * face.normal;
    area += face.area;
  }

  void add(const Bundle& other) {
    box.low = glm::min(box.low, other.box.low);
    box.high = glm::max(box.high, other.box.high);
    normals += other.normals;
    area += other.area;
  }

  /// For a cone of directions that is evenly filled and has the same mean normal, whose length then is
  /// (1 + cos t) / 2.
  [[nodiscard]] double cost() const {
    const glm::dvec3 d = box.high - box.low;
    const double surface = d.x * d.y + d.y * d.z + d.z * d.x;
    const double cosine = std::clamp(2 * glm::length(normals) / area - 1, -1.0, 1.0);
    const double t = std::acos(cosine), w = std::min(std::numbers::pi, t + std::numbers::pi / 2);
    const double directions =
        2 * std::numbers::pi * (1 - cosine) +
        std::numbers::pi / 2 * (2 * (w - t) * std::sin(t) - std::cos(t - 2 * w) + cosine);
    return area * surface * directions;
  }
};

class Builder {
 public:
  explicit Builder(std::span<const Node> faces) {
    faces_.reserve(faces.size());
    for (const Node& face : faces)
      faces_.push_back({face.shape.centroid, face.radius, face.shape.normal, face.shape.area,
                        static_cast<std::uint32_t>(faces_.size()), face.front});
  }

  ClusterTree build(int threads) {
    if (faces_.size() > 1) {
      tree_.clusters.resize(faces_.size() - 1);
      tbb::task_arena arena(threads);
      arena.execute([&] { build(0, faces_.size(), 0); });
    }
    tree_.faces.reserve(faces_.size());
    for (const Face& face : faces_) tree_.faces.push_back(face.number);
    return std::move(tree_);
  }

 private:
  /// What is above n faces are n - 1 clusters, which stand together, from the one that is given on. Returns
  /// its cone.
  Cone build(std::size_t first, std::size_t last, std::size_t number) {
    if (last - first == 1) return {faces_[first].normal, 0};
    const std::size_t middle = divide(first, last);
    ClusterTree::Cluster& cluster = tree_.clusters[number];
    cluster.first = static_cast<std::uint32_t>(first), cluster.last = static_cast<std::uint32_t>(last);
    const auto build_half = [&](std::size_t half, std::size_t from, std::size_t to, std::size_t child) {
      cluster.child[half] =
          to - from > 1 ? static_cast<std::uint32_t>(child) : ClusterTree::kFace + faces_[from].number;
      return build(from, to, child);
    };
    std::array<Cone, 2> cones;
    const auto build_first = [&] { cones[0] = build_half(0, first, middle, number + 1); };
    const auto build_second = [&] { cones[1] = build_half(1, middle, last, number + (middle - first)); };
    if (last - first >= kApart) {
      tbb::parallel_invoke(build_first, build_second);
    } else {
      build_first();
      build_second();
    }
    return cluster.cone = unite(cones[0], cones[1]);
  }

  /// Orders faces_[first, last) so that the halves stand on either side of the place that is given back.
  std::size_t divide(std::size_t first, std::size_t last) {
    const std::span faces = std::span(faces_).subspan(first, last - first);
    // Fronts and backs lie at the same places, but in different light: inside and outside of a post.
    if (faces.size() == faces_.size())
      if (const std::size_t fronts = part(faces, [](const Face& face) { return face.front; });
          fronts > 0 && fronts < faces.size())
        return fronts;
    if (faces.size() == 2) return first + 1;
    Box centroids{glm::dvec3(kInfinity), glm::dvec3(-kInfinity)};
    for (const Face& face : faces) {
      centroids.low = glm::min(centroids.low, face.centroid);
      centroids.high = glm::max(centroids.high, face.centroid);
    }
    double best = kInfinity;
    int best_axis = -1;
    std::size_t best_bin = 0;
    const auto bin_of = [&](const Face& face, int axis) {
      const double width = centroids.high[axis] - centroids.low[axis];
      const double at = (face.centroid[axis] - centroids.low[axis]) / width;
      return std::min(kBins - 1, static_cast<std::size_t>(at * kBins));
    };
    for (int axis = 0; axis < 3; ++axis) {
      if (!(centroids.high[axis] > centroids.low[axis])) continue;
      std::array<Bundle, kBins> bins;
      for (const Face& face : faces) bins[bin_of(face, axis)].add(face);
      std::array<double, kBins> from_here{};
      Bundle sum;
      double cost = kInfinity;
      for (std::size_t bin = kBins - 1; bin > 0; --bin) {
        if (bins[bin].area > 0) {
          sum.add(bins[bin]);
          cost = sum.cost();
        }
        from_here[bin] = cost;
      }
      sum = {};
      for (std::size_t bin = 0; bin + 1 < kBins; ++bin) {
        if (bins[bin].area == 0) continue;
        sum.add(bins[bin]);
        if (const double both = sum.cost() + from_here[bin + 1]; both < best) {
          best = both;
          best_axis = axis;
          best_bin = bin;
        }
      }
    }
    if (best_axis < 0) return first + faces.size() / 2;  // all centroids are one point
    return first + part(faces, [&](const Face& face) { return bin_of(face, best_axis) <= best_bin; });
  }

  /// Puts those that are of the first part first. Returns their number.
  template <class IsFirst>
  static std::size_t part(std::span<Face> faces, const IsFirst& is_first) {
    const auto middle = std::stable_partition(faces.begin(), faces.end(), is_first);
    return static_cast<std::size_t>(middle - faces.begin());
  }

  std::vector<Face> faces_;
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

ClusterTree build_cluster_tree(std::span<const Node> faces, int threads) {
  return Builder(faces).build(threads);
}

}  // namespace fluxel
