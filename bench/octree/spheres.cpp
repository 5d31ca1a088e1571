#include "bench/octree/spheres.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/sampling.hpp"
#include "scene/polygon.hpp"

namespace fluxel::bench {

std::vector<glm::dvec3> points_on(const Scene& scene, std::size_t count, std::uint64_t seed) {
  std::vector<double> ends;
  double sum = 0;
  for (const Piece& piece : scene.pieces) ends.push_back(sum += area(corners(piece.outline)));
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform;
  std::vector<glm::dvec3> points;
  for (std::size_t k = 0; k < count; ++k) {
    const auto found = std::ranges::upper_bound(ends, uniform(random) * sum);
    const auto piece = std::min(static_cast<std::size_t>(found - ends.begin()), ends.size() - 1);
    const double u = uniform(random);
    points.push_back(surface_point(scene.pieces[piece].outline, u, uniform(random)));
  }
  return points;
}

SphereSet spheres_on(const Scene& scene, std::size_t count, double overlap) {
  double area_of_all = 0;
  for (const Piece& piece : scene.pieces) area_of_all += area(corners(piece.outline));
  SphereSet set;
  set.radius = std::sqrt(overlap * area_of_all / (std::numbers::pi * static_cast<double>(count)));
  for (const glm::dvec3& point : points_on(scene, count, 1))
    set.spheres.push_back({static_cast<float>(point.x), static_cast<float>(point.y),
                           static_cast<float>(point.z), static_cast<float>(set.radius)});
  return set;
}

}  // namespace fluxel::bench
