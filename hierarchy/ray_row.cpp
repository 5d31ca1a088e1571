#include "hierarchy/ray_row.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>
#include <utility>

#include "core/sampling.hpp"

namespace fluxel {

namespace {

/// Whether a point of a face from the unit square (see surface_point) lies in the second half, as
/// edge_to_halve would part it.
bool in_second_half(const NodeTree& tree, NodeId face, double u, double v) {
  const std::uint32_t edge = edge_to_halve(tree, face);
  if (tree.outline(face).corners == 4) return (edge % 2 == 0 ? u : v) >= 0.5;
  const double root = std::sqrt(u);
  const std::array<double, 3> at{1 - root, root * (1 - v), root * v};
  // A back has its corners the other way round.
  const auto corner = [&](std::uint32_t k) { return at[tree[face].front ? k : 2 - k]; };
  return corner(edge) < corner((edge + 1) % 3);
}

/// Of a leaf or its other side; those of one node are in different clusters.
bool lies_in(const NodeTree& tree, NodeId leaf, NodeId node) {
  for (NodeId side : {leaf, tree[leaf].twin}) {
    // Numbers fall on the way up.
    while (side != kNoNode && side > node) side = tree[side].parent;
    if (side == node) return true;
  }
  return false;
}

/// A ray of a hemisphere, from where it starts.
struct RowRay {
  ReceivingPoint at;
  NodeId face = kNoNode;
  std::size_t half = 0;
  MetLeaf met;
  bool counts = true;
};

/// Numbers for directions that are even, and not paired with places of the same sequence.
std::vector<std::array<double, SobolPoints::kAxes>> shuffled_points(std::uint64_t seed, std::size_t count) {
  SobolPoints points(random_bits(~seed));
  std::vector<std::array<double, SobolPoints::kAxes>> numbers(count);
  for (auto& number : numbers) number = points.next();
  for (std::size_t k = count; k > 1; --k) std::swap(numbers[k - 1], numbers[random_bits(seed + k) % k]);
  return numbers;
}

/// Beside the node's size: what ends nearer than that stands close to it.
constexpr double kNearEnd = 0.3;

/// Two from each point, of which one counts if the other leaves a cluster, or does not end close to a face:
/// what lies open is what is seen of a node, and its inside, or what something hovers over, is mostly dark.
std::vector<RowRay> rays_of(const RayLight& light, NodeId node, int count) {
  const NodeTree& tree = light.tree();
  const bool is_cluster = tree.is_cluster(node);
  std::vector<RowRay> rays(static_cast<std::size_t>(count));
  SobolPoints points(node);
  const auto directions = shuffled_points(std::uint64_t{node} | std::uint64_t{1} << 40, rays.size());
  for (std::size_t k = 0; k < rays.size(); ++k) {
    RowRay& ray = rays[k];
    if (k % 2 == 1) {
      ray = rays[k - 1];
    } else if (!is_cluster) {
      const auto [u, v, unused, other] = points.next();
      ray.face = node;
      ray.half = in_second_half(tree, node, u, v) ? 1 : 0;
      ray.at = light.receiving(node, surface_point(tree.outline(node), u, v));
    } else {
      auto [u, v, unused, other] = points.next();
      ray.half = u < tree[tree[node].child[0]].shape.area / tree[node].shape.area ? 0 : 1;
      ray.face = tree.random_face(node, u);
      ray.at = light.receiving(ray.face, surface_point(tree.outline(ray.face), u, v));
    }
    ray.met = light.first_met(light.hemisphere_ray(ray.at, directions[k][0], directions[k][1]));
  }
  const auto leaves = [&](const RowRay& ray) {
    if (ray.met.leaf == kNoNode) return true;
    if (is_cluster) return !lies_in(tree, ray.met.leaf, node);
    const glm::dvec3 way = ray.met.point - ray.at.position;
    return glm::dot(way, way) >= kNearEnd * kNearEnd * tree[node].shape.moments.trace();
  };
  bool any = false;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    rays[k].counts = (k ^ 1) < rays.size() && leaves(rays[k ^ 1]);
    any = any || rays[k].counts;
  }
  if (!any)
    for (RowRay& ray : rays) ray.counts = true;
  return rays;
}

/// Rays to luminaires from each of these starts; where there are more luminaires they are drawn from.
constexpr std::size_t kLuminaireDraws = 4;

/// Starts of rays to emitters: points that rays which count start from, as often as they count.
struct LampStart {
  std::uint32_t ray = 0;
  double weight = 1;
};

std::vector<LampStart> lamp_starts(std::span<const RowRay> rays, int count) {
  std::vector<LampStart> starts;
  constexpr std::size_t kFromAPoint = 2;
  for (std::size_t k = 0; k < rays.size() && starts.size() < static_cast<std::size_t>(count);
       k += kFromAPoint) {
    double weight = 0;
    for (std::size_t j = k; j < std::min(rays.size(), k + kFromAPoint); ++j) weight += rays[j].counts ? 1 : 0;
    if (weight > 0) starts.push_back({static_cast<std::uint32_t>(k), weight});
  }
  return starts;
}

/// Irradiance by emission that rays of one kind find: for each side of the cube, and for each half.
class EmittedLight {
 public:
  explicit EmittedLight(bool is_cluster) : is_cluster_(is_cluster) {}

  void add_weight(const RowRay& ray, double weight) {
    add_parts(ray, weight, side_weights_);
    weights_[ray.half] += weight;
  }
  void add(const RowRay& ray, double weight, const Rgb& light) {
    add_parts(ray, weight * light, sides_);
    const double size = mean_of_colours(light);
    sums_[ray.half] += weight * size;
    squares_[ray.half] += weight * size * size;
  }
  /// Adds the means over the rays there were.
  void add_to(RayRow& row) const {
    for (std::size_t side = 0; side < kCubeSides; ++side)
      if (side_weights_[side] > 0) row.emitted[side] += sides_[side] / side_weights_[side];
    for (std::size_t half = 0; half < 2; ++half) {
      if (!(weights_[half] > 0)) continue;
      const double mean = sums_[half] / weights_[half];
      row.half_emitted[half] += mean;
      row.half_variance[half] +=
          std::max(0.0, squares_[half] / weights_[half] - mean * mean) / std::max(1.0, weights_[half] - 1);
    }
  }

 private:
  template <class Value>
  void add_parts(const RowRay& ray, const Value& value, std::array<Value, kCubeSides>& to) const {
    const CubeParts parts = is_cluster_ ? cube_parts(ray.at.normal) : CubeParts{1, 0, 0};
    for (std::size_t axis = 0; axis < parts.size(); ++axis)
      to[is_cluster_ ? cube_side(axis, ray.at.normal) : axis] += parts[axis] * value;
  }

  bool is_cluster_;
  std::array<Rgb, kCubeSides> sides_{};
  std::array<double, kCubeSides> side_weights_{};
  std::array<double, 2> sums_{}, squares_{}, weights_{};
};

/// On the face of its whole piece, in the precision that it is kept in, and the leaf that this place lies on.
RayEnd end_of(const NodeTree& tree, const RowRay& ray) {
  const Node& leaf = tree[ray.met.leaf];
  const NodeId face = tree.face(leaf.piece, leaf.front);
  const glm::dvec2 place = tree.place(face, ray.met.point);
  RayEnd end{face, ray.face, {static_cast<float>(place.x), static_cast<float>(place.y)}, ray.half == 1};
  descend(tree, end);
  return end;
}

}  // namespace

std::uint32_t edge_to_halve(const NodeTree& tree, NodeId face) {
  return tree[face].is_leaf() ? tree.longest_edge(face) : tree[face].halved;
}

RayRow trace_row(const RayLight& light, NodeId node, const RayNumbers& numbers, std::uint64_t& traced) {
  const NodeTree& tree = light.tree();
  const bool is_cluster = tree.is_cluster(node);
  const std::vector<RowRay> rays = rays_of(light, node, numbers.hemisphere);
  RayRow row;
  row.node = node;
  EmittedLight met(is_cluster), drawn(is_cluster), of_luminaires(is_cluster);
  for (const RowRay& ray : rays) {
    if (!ray.counts) continue;
    ++row.rays[ray.half];
    const CubeParts parts = is_cluster ? cube_parts(ray.at.normal) : CubeParts{1, 0, 0};
    for (std::size_t axis = 0; axis < parts.size(); ++axis)
      row.half_weights[ray.half][is_cluster ? cube_side(axis, ray.at.normal) : axis] += parts[axis];
    met.add_weight(ray, 1);
    if (ray.met.leaf == kNoNode) continue;
    row.ends.push_back(end_of(tree, ray));
    met.add(ray, 1,
            static_cast<double>(numbers.hemisphere) *
                light.emitted(ray.at, ray.met, numbers, [&](NodeId face, const glm::dvec3& of) {
                  return light.emitters().density(face, of, ray.at);
                }));
  }
  const std::vector<LampStart> starts = lamp_starts(rays, numbers.lamps);
  const auto points = shuffled_points(std::uint64_t{node}, starts.size());
  RayLight::Lamps to_lamps(light, numbers, [&](std::uint32_t number, const Rgb& emitted) {
    drawn.add(rays[starts[number].ray], starts[number].weight, static_cast<double>(numbers.lamps) * emitted);
  });
  for (std::uint32_t k = 0; k < starts.size(); ++k) {
    const RowRay& start = rays[starts[k].ray];
    const ReceivingPoint& at = start.at;
    drawn.add_weight(start, starts[k].weight);
    if (!light.luminaires().empty()) {
      of_luminaires.add_weight(start, starts[k].weight);
      of_luminaires.add(start, starts[k].weight,
                        light.luminaires().sampled_irradiance({at.position, at.normal}, kLuminaireDraws,
                                                              random_bits(random_bits(node) + k), traced));
    }
    if (!light.emitters().empty())
      to_lamps.point(k, at, light.emitters().draw(at, points[k][0], points[k][1], points[k][2]));
  }
  traced += rays.size() + to_lamps.finish();
  met.add_to(row);
  drawn.add_to(row);
  of_luminaires.add_to(row);
  return row;
}

void descend(const NodeTree& tree, RayEnd& end) {
  const NodeId face = tree.face(tree[end.leaf].piece, tree[end.leaf].front);
  const glm::dvec2 along = glm::dvec2(end.place[0], end.place[1]) * tree[face].extent;
  end.leaf = tree.leaf_below(
      face, tree[face].shape.centroid + along.x * tree.axes(face).u + along.y * tree.axes(face).v);
}

double deviation(const NodeTree& tree, const RayRow& row, std::span<const double> reflected) {
  const bool is_cluster = tree.is_cluster(row.node);
  // What the cube tells of each side.
  std::array<double, kCubeSides> cube{};
  const auto parts_of = [&](const RayEnd& end) {
    return is_cluster ? cube_parts(tree[end.from].shape.normal) : CubeParts{1, 0, 0};
  };
  const auto side_of = [&](const RayEnd& end, std::size_t axis) {
    return is_cluster ? cube_side(axis, tree[end.from].shape.normal) : axis;
  };
  for (std::size_t k = 0; k < row.ends.size(); ++k) {
    const CubeParts parts = parts_of(row.ends[k]);
    for (std::size_t axis = 0; axis < parts.size(); ++axis)
      cube[side_of(row.ends[k], axis)] += parts[axis] * reflected[k];
  }
  for (std::size_t side = 0; side < kCubeSides; ++side)
    cube[side] =
        (row.weight(side) > 0 ? cube[side] / row.weight(side) : 0) + mean_of_colours(row.emitted[side]);
  if (row.rays[0] < 2 || row.rays[1] < 2) {
    // As much as may be, where nothing tells.
    double sum = 0, weight = 0;
    for (std::size_t side = 0; side < kCubeSides; ++side) {
      sum += row.weight(side) * cube[side];
      weight += row.weight(side);
    }
    return weight > 0 ? sum / weight : 0;
  }
  std::array<double, 2> sums{}, squares{}, beyond{};
  for (std::size_t k = 0; k < row.ends.size(); ++k) {
    const std::size_t half = row.ends[k].second_half ? 1 : 0;
    sums[half] += reflected[k];
    squares[half] += reflected[k] * reflected[k];
  }
  double noise = 0;
  for (std::size_t half = 0; half < 2; ++half) {
    const double rays = row.rays[half];
    double told = 0;
    for (std::size_t side = 0; side < kCubeSides; ++side) told += row.half_weights[half][side] * cube[side];
    beyond[half] = (sums[half] - told) / rays + row.half_emitted[half];
    noise += (squares[half] / rays - sums[half] * sums[half] / (rays * rays)) / (rays - 1) +
             row.half_variance[half];
  }
  const double apart = beyond[0] - beyond[1];
  constexpr double kUnseen = 0.05;
  return 0.5 * std::sqrt(std::max(kUnseen * noise, apart * apart - noise));
}

}  // namespace fluxel
