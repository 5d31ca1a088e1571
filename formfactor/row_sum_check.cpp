#include "formfactor/row_sum_check.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/sampling.hpp"
#include "formfactor/even_points.hpp"
#include "scene/piece_draw.hpp"
#include "visibility/first_side.hpp"

namespace fluxel {

namespace {

constexpr std::size_t kRaysOfRows = 4'000'000, kLeastRaysOfRow = 256, kMostRaysOfRow = 1 << 16;
constexpr double kWidth = 5;  // standard errors

std::vector<PieceDraw> pieces_of_surfaces(const Scene& scene) {
  std::vector<PieceDraw> surfaces(2 * scene.groups.size());
  for (const Piece& piece : scene.pieces) {
    const Patch& patch = scene.patch(piece.patch);
    for (const bool back : {false, true}) {
      if ((patch.sides & (back ? kBack : kFront)) == 0) continue;
      surfaces[surface_of(static_cast<std::uint32_t>(patch.group), back)].add(piece);
    }
  }
  return surfaces;
}

/// The part of a surface's rays that end on sides that are unknowns.
double part_seen(const FirstSide& first_side, const Scene& scene, double lift, const PieceDraw& of, bool back,
                 std::uint64_t seed, std::size_t rays) {
  SobolPoints points(seed);
  std::size_t seen = 0;
  for (std::size_t k = 0; k < rays; ++k) {
    const auto [u, v, s, t] = points.next();
    const double choice = static_cast<double>(random_bits(random_bits(seed) + k) >> 11) * 0x1p-53;
    const Piece& piece = of.draw(choice).piece;
    const glm::dvec3 normal = (back ? -1.0 : 1.0) * scene.patch(piece.patch).normal;
    const glm::dvec3 from = surface_point(piece.outline, s, t) + lift * normal;
    const MetSide met = first_side.meet(from, cosine_direction(u, v, normal));
    if (met.patch != kNoPatch && met.active) ++seen;
  }
  return static_cast<double>(seen) / static_cast<double>(rays);
}

}  // namespace

std::vector<DoubtfulRow> doubtful_rows(const RayScene& ray_scene, const ExchangeTable& of_groups) {
  const Scene& scene = ray_scene.scene();
  const std::vector<PieceDraw> surfaces = pieces_of_surfaces(scene);
  const std::size_t rays =
      std::clamp(kRaysOfRows / std::max<std::size_t>(1, surfaces.size()), kLeastRaysOfRow, kMostRaysOfRow);
  std::vector<double> sums(surfaces.size(), 0), errors(surfaces.size(), 0), seen(surfaces.size(), 0);
  visit_rows(of_groups, [&](std::span<const SurfaceViewFactor> row) {
    for (const SurfaceViewFactor& of : row) {
      sums[of.from] += of.value;
      errors[of.from] += of.error;
    }
  });
  const FirstSide first_side(ray_scene);
  tbb::parallel_for(std::size_t{0}, surfaces.size(), [&](std::size_t k) {
    if (!surfaces[k].empty())
      seen[k] = part_seen(first_side, scene, static_cast<double>(ray_scene.surface_epsilon()), surfaces[k],
                          k % 2 == 1, random_bits(k), rays);
  });
  std::vector<DoubtfulRow> doubtful;
  const auto count = static_cast<double>(rays);
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    if (surfaces[k].empty()) continue;
    // By the rule of succession, where all rays or none are seen.
    const double part = (seen[k] * count + 1) / (count + 2);
    const double allowed = errors[k] + kWidth * std::sqrt(part * (1 - part) / count);
    if (std::abs(sums[k] - seen[k]) > allowed)
      doubtful.push_back({static_cast<std::uint32_t>(k), sums[k], seen[k]});
  }
  return doubtful;
}

}  // namespace fluxel
