#include "hierarchy/first_light.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "core/sampling.hpp"
#include "formfactor/even_points.hpp"
#include "hierarchy/gather.hpp"

namespace fluxel {

namespace {

/// Of a face, by its share of the scene: the less of it hides in one mean, the fewer.
constexpr std::size_t kLeastPoints = 16, kMostPoints = 1024;
constexpr double kPointsOfAll = 8192;

/// Rays from each: where there are more luminaires they are drawn from.
constexpr std::size_t kDraws = 32;

/// Of these rays. Where each luminaire has some they are the same from all points of all faces: openings are
/// then so many points, which send as much light, and the field is smooth. Noise would be a residual that no
/// splitting makes less, and links would be refined without end. Drawn ones are those of the face.
std::uint64_t seed_of(const LuminaireLight& luminaires, NodeId face) {
  return luminaires.size() <= kDraws ? 0 : random_bits(~std::uint64_t{face});
}

/// A power of two, of which Sobol points are most even.
std::size_t points_of(const NodeTree& tree, NodeId face) {
  const double wanted = kPointsOfAll * tree[face].shape.area / tree[0].shape.area;
  return std::bit_ceil(static_cast<std::size_t>(
      std::clamp(wanted, static_cast<double>(kLeastPoints), static_cast<double>(kMostPoints))));
}

/// A part of a face, as one of the unit square, that no luminaire is nearer to than it is large.
struct FacePart {
  glm::dvec2 low{0};
  double side = 1;
};

/// Of each, so many points at least; and parts of a face at most, as where an opening crosses it.
constexpr std::size_t kPointsOfPart = 4, kMostParts = 512;

bool is_near(const LuminaireLight& luminaires, const Outline<glm::dvec3>& outline, const FacePart& part) {
  const auto at = [&](double u, double v) {
    return surface_point(outline, part.low.x + u * part.side, part.low.y + v * part.side);
  };
  const double across = std::max(glm::distance(at(0, 0), at(1, 1)), glm::distance(at(1, 0), at(0, 1)));
  return across > luminaires.distance(at(0.5, 0.5));
}

/// The whole face, or where a luminaire is near parts that are the smaller the nearer it is, as its light
/// varies.
std::vector<FacePart> parts_of(const LuminaireLight& luminaires, const Outline<glm::dvec3>& outline) {
  std::vector<FacePart> parts, wide{FacePart{}};
  if (luminaires.size() > kDraws) return wide;  // most are far, and they are drawn from
  while (!wide.empty() && parts.size() + 4 * wide.size() <= kMostParts) {
    std::vector<FacePart> quarters;
    for (const FacePart& part : wide) {
      if (!is_near(luminaires, outline, part)) {
        parts.push_back(part);
        continue;
      }
      const double half = 0.5 * part.side;
      for (const glm::dvec2 low :
           {glm::dvec2(0, 0), glm::dvec2(half, 0), glm::dvec2(0, half), glm::dvec2(half)})
        quarters.push_back({part.low + low, half});
    }
    wide = std::move(quarters);
  }
  parts.insert(parts.end(), wide.begin(), wide.end());
  return parts;
}

}  // namespace

FirstLight first_light(const LuminaireLight& luminaires, const NodeTree& tree, NodeId face,
                       std::uint64_t& traced) {
  const Outline<glm::dvec3> outline = tree.outline(face);
  const glm::dvec3& normal = tree[face].shape.normal;
  SobolPoints points(random_bits(face));
  std::vector<glm::dvec2> places;
  std::vector<Rgb> light;
  std::vector<double> shares;  // of the face's area
  FirstLight first;
  glm::dvec2 middle(0);
  for (const FacePart& part : parts_of(luminaires, outline)) {
    const double area = part.side * part.side;
    const std::size_t count =
        std::max(kPointsOfPart, static_cast<std::size_t>(area * static_cast<double>(points_of(tree, face))));
    for (std::size_t k = 0; k < count; ++k) {
      const auto [u, v, unused, other] = points.next();
      const glm::dvec3 point = surface_point(outline, part.low.x + u * part.side, part.low.y + v * part.side);
      places.push_back(tree.place(face, point));
      light.push_back(
          luminaires.sampled_irradiance({point, normal}, kDraws, seed_of(luminaires, face), traced));
      shares.push_back(area / static_cast<double>(count));
      middle += places.back() * shares.back();
      first.mean += light.back() * shares.back();
    }
  }
  // Least squares over the points.
  glm::dmat2 squares(0);
  glm::dmat2x3 products(0);
  double variance = 0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const glm::dvec2 place = places[k] - middle;
    const Rgb off = light[k] - first.mean;
    squares += glm::outerProduct(place, place) * shares[k];
    products += glm::outerProduct(off, place) * shares[k];
    variance += mean_of_colours(off) * mean_of_colours(off) * shares[k];
  }
  if (glm::determinant(squares) > 0) {
    const glm::dmat2x3 slope = products * glm::inverse(squares);
    first.slope = {slope[0], slope[1]};
    first.mean -= slope * middle;  // at the centroid, of which the points' middle is a little off
    variance -= mean_of_colours(slope[0]) * mean_of_colours(products[0]) +
                mean_of_colours(slope[1]) * mean_of_colours(products[1]);
  }
  first.mean = glm::max(first.mean, Rgb(0));
  first.residual = std::sqrt(std::max(0.0, variance));
  return first;
}

std::uint64_t FirstLightOfLeaves::find(const Ranks& ranks, int threads) {
  if (empty()) return 0;
  std::vector<NodeId> wanted;
  const std::size_t before = of_nodes_.size();
  for (std::size_t id = tree_.clusters() + before; id < tree_.size(); ++id)
    if (tree_[static_cast<NodeId>(id)].is_leaf()) wanted.push_back(static_cast<NodeId>(id));
  of_nodes_.resize(tree_.size() - tree_.clusters());
  std::vector<FirstLight> own((wanted.size() + ranks.size - 1 - ranks.rank) / ranks.size);
  std::atomic<std::uint64_t> rays = 0;
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, own.size(), 16), [&](const auto& range) {
      std::uint64_t traced = 0;
      for (std::size_t k = range.begin(); k < range.end(); ++k)
        own[k] = first_light(luminaires_, tree_, wanted[k * ranks.size + ranks.rank], traced);
      rays += traced;
    });
  });
  const std::vector<FirstLight> all = ranks.gather(std::span<const FirstLight>(own));
  std::size_t next = 0;
  for (std::size_t rank = 0; rank < ranks.size; ++rank)
    for (std::size_t k = rank; k < wanted.size(); k += ranks.size)
      of_nodes_[wanted[k] - tree_.clusters()] = all[next++];
  return rays;
}

std::array<std::vector<Rgb>, 2> first_light_of_points(const LuminaireLight& luminaires, const NodeTree& tree,
                                                      std::span<const GatherPoint> points,
                                                      const GatherGoal& goal, const Ranks& ranks, int threads,
                                                      std::uint64_t& traced) {
  using OfPoint = std::array<Rgb, 2>;
  std::array halves{std::vector<Rgb>(points.size(), Rgb(0)), std::vector<Rgb>(points.size(), Rgb(0))};
  if (luminaires.empty()) return halves;
  std::vector<OfPoint> own((points.size() + ranks.size - 1 - ranks.rank) / ranks.size,
                           OfPoint{Rgb(0), Rgb(0)});
  std::atomic<std::uint64_t> rays = 0;
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, own.size(), 16), [&](const auto& range) {
      std::uint64_t of_range = 0;
      for (std::size_t k = range.begin(); k < range.end(); ++k) {
        const std::size_t number = k * ranks.size + ranks.rank;
        const GatherPoint& point = points[number];
        if (point.face == kNoNode) continue;
        own[k] = luminaires.irradiance_halves(
            {point.position, tree[point.face].shape.normal},
            rays_a_spread(goal, mean_of_colours(tree.material(point.face).rho), point.weight),
            random_bits(random_bits(goal.seed) + number), of_range);
      }
      rays += of_range;
    });
  });
  traced += rays;
  const std::vector<OfPoint> all = ranks.gather(std::span<const OfPoint>(own));
  std::size_t next = 0;
  for (std::size_t rank = 0; rank < ranks.size; ++rank)
    for (std::size_t k = rank; k < points.size(); k += ranks.size, ++next)
      for (std::size_t half = 0; half < halves.size(); ++half) halves[half][k] = all[next][half];
  return halves;
}

}  // namespace fluxel
