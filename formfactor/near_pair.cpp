#include "formfactor/near_pair.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/sampling.hpp"
#include "formfactor/exchange.hpp"
#include "formfactor/pair_rule.hpp"

namespace fluxel {

namespace {

/// One side of an element: its corners counter-clockwise about the normal of that side.
struct FacingPolygon {
  SampledPolygon polygon;
  Plane plane;
};

FacingPolygon facing(const Scene& scene, const ElementView& mesh, std::size_t i, std::uint32_t side) {
  const Outline<glm::dvec3> outline = widen(mesh.outlines[i]);
  const PolygonView front = corners(outline);
  FacingPolygon result;
  result.polygon.corners.assign(front.begin(), front.end());
  result.polygon.normal = scene.patch(mesh.elements[i].patch).normal;
  if (side == 1) {
    std::ranges::reverse(result.polygon.corners);
    result.polygon.normal = -result.polygon.normal;
  }
  result.plane = {glm::dvec3(mesh.elements[i].centroid), result.polygon.normal};
  return result;
}

bool has_side(const Element& element, std::uint32_t side) {
  return (element.sides & (side == 0 ? kFront : kBack)) != 0;
}

std::vector<glm::dvec3> grid_points(const Outline<glm::vec3>& outline, const PointGrid& grid) {
  std::vector<glm::dvec3> points;
  for (int a = 0; a < grid.m; ++a)
    for (int b = 0; b < grid.n; ++b)
      points.push_back(surface_point(outline, (a + 0.5) / grid.m, (b + 0.5) / grid.n));
  return points;
}

}  // namespace

PairExaminer::PairExaminer(const OcclusionScene& occlusion, const Scene& scene, const ElementView& mesh,
                           const FormFactorOptions& options, const PowerEstimate& power)
    : occlusion_(occlusion), scene_(scene), mesh_(mesh), options_(options), power_(power) {}

double PairExaminer::visible_part(const SampledPolygon& P, const SampledPolygon& Q, double G, std::size_t i,
                                  std::size_t j, double share, TileOccluders& occluders,
                                  CorrectionCounts& counts) const {
  const RayBudget budget{share, kRayTolerance * options_.tolerance, kUnanimousTolerance * options_.tolerance};
  const double rays = std::min<double>(rays_at_an_edge(budget), kMaxPairRays);
  const auto most = std::min(static_cast<std::size_t>(rays / kRaysOfAnOccluder), kMaxClippedOccluders);
  if (const auto candidates = most > 0 ? occluders.candidates(i) : std::nullopt) {
    const double tolerance = kClippingPart * error_at_an_edge(rays) * G;
    const std::optional<Exchange> clipped =
        exchange_past_few(occlusion_, {P, Q, *candidates}, {.G = G}, tolerance, most);
    if (clipped) {
      ++counts.clipped_pairs;
      if (clipped->G > 0 && clipped->G < G) ++counts.partial_pairs;
      return std::min(clipped->G, G);
    }
  }
  // The elements' numbers alone make the seed, so that every rank would draw the same points.
  const VisibleFraction found =
      visible_fraction(occlusion_.ray_scene, P, Q, std::uint64_t{i} << 32 | j, budget);
  counts.rays += found.rays + found.pilots;
  if (found.value > 0 && found.value < 1) ++counts.partial_pairs;
  return G * found.value;
}

SideExchanges PairExaminer::exchange(std::size_t i, std::size_t j, bool near, bool sees,
                                     TileOccluders& occluders, CorrectionCounts& counts) const {
  const Element &element_i = mesh_.elements[i], &element_j = mesh_.elements[j];
  const auto epsilon = static_cast<double>(occlusion_.ray_scene.surface_epsilon());
  const auto least_area = static_cast<double>(std::min(element_i.area, element_j.area));
  SideExchanges found;
  for (std::uint32_t side_i = 0; side_i < 2; ++side_i) {
    if (!has_side(element_i, side_i)) continue;
    const FacingPolygon of_i = facing(scene_, mesh_, i, side_i);
    for (std::uint32_t side_j = 0; side_j < 2; ++side_j) {
      if (!has_side(element_j, side_j)) continue;
      const FacingPolygon of_j = facing(scene_, mesh_, j, side_j);
      const SampledPolygon P{clip_to_front(corners(of_i.polygon.corners), of_j.plane, epsilon),
                             of_i.polygon.normal};
      const SampledPolygon Q{clip_to_front(corners(of_j.polygon.corners), of_i.plane, epsilon),
                             of_j.polygon.normal};
      if (P.corners.empty() || Q.corners.empty()) continue;
      SideExchange pair{side_i, side_j, 0};
      const bool centroids_face =
          of_j.plane.distance(of_i.plane.point) > 0 && of_i.plane.distance(of_j.plane.point) > 0;
      const bool whole = std::ranges::equal(P.corners, of_i.polygon.corners) &&
                         std::ranges::equal(Q.corners, of_j.polygon.corners);
      // Moments know the whole elements only, and would give all of it to each pair of sides.
      pair.G = !near && centroids_face && whole
                   ? static_cast<double>(element_i.area) *
                         pair_form_factor(PairRule::moments, element_i, element_j)
                   : free_exchange(P, Q, kPairTolerance * options_.tolerance * least_area).G;
      const double share = power_.share(
          i + side_i * mesh_.elements.size(), j + side_j * mesh_.elements.size(),
          pair.G / static_cast<double>(element_i.area), pair.G / static_cast<double>(element_j.area));
      if ((options_.partial_visibility && share > kMinShare * options_.tolerance) || !centroids_face)
        pair.G = visible_part(P, Q, pair.G, i, j, share, occluders, counts);
      else if (!sees)
        pair.G = 0;
      found.push_back(pair);
    }
  }
  return found;
}

SideExchanges PairExaminer::exchange_by_points(std::size_t i, std::size_t j, CorrectionCounts& counts) const {
  const Element &element_i = mesh_.elements[i], &element_j = mesh_.elements[j];
  const std::vector<glm::dvec3> points = grid_points(mesh_.outlines[i], options_.points);
  const std::vector<glm::dvec3> targets = grid_points(mesh_.outlines[j], options_.points);
  const glm::dvec3 normal_i(element_i.normal), normal_j(element_j.normal);
  const auto count = static_cast<double>(points.size());
  const double area_i = static_cast<double>(element_i.area) / count;
  const double area_j = static_cast<double>(element_j.area) / count;
  const auto least_height = static_cast<double>(kFacingHeights * occlusion_.ray_scene.surface_epsilon());
  std::array<double, 4> G{};
  for (const glm::dvec3& point : points) {
    for (std::size_t first = 0; first < targets.size(); first += RayPacket::kSize) {
      const auto some =
          std::span(targets).subspan(first, std::min<std::size_t>(RayPacket::kSize, targets.size() - first));
      std::array<SurfaceSegment, RayPacket::kSize> segments;
      for (std::size_t k = 0; k < some.size(); ++k) {
        const glm::dvec3 d = some[k] - point;
        segments[k] = {point, std::copysign(1.0, glm::dot(normal_i, d)) * normal_i, some[k],
                       std::copysign(1.0, -glm::dot(normal_j, d)) * normal_j};
      }
      const std::uint32_t free = free_segments(occlusion_.ray_scene, std::span(segments).first(some.size()));
      counts.rays += some.size();
      for (std::size_t k = 0; k < some.size(); ++k) {
        const glm::dvec3 d = some[k] - point;
        const double height_i = glm::dot(normal_i, d), height_j = -glm::dot(normal_j, d);
        const std::uint32_t side_i = height_i > 0 ? 0 : 1, side_j = height_j > 0 ? 0 : 1;
        if ((free >> k & 1u) == 0 || !has_side(element_i, side_i) || !has_side(element_j, side_j)) continue;
        if (std::abs(height_i) <= least_height || std::abs(height_j) <= least_height) continue;
        const double r2 = glm::dot(d, d);
        G[2 * side_i + side_j] += area_i * area_j * std::abs(height_i * height_j) /
                                  (r2 * (std::numbers::pi * r2 + std::max(area_i, area_j)));
      }
    }
  }
  SideExchanges found;
  for (std::uint32_t sides = 0; sides < 4; ++sides)
    if (G[sides] > 0) found.push_back({sides / 2, sides % 2, G[sides]});
  return found;
}

}  // namespace fluxel
