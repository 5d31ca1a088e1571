#include "formfactor/surface_exchange.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <stdexcept>
#include <utility>

#include "formfactor/pair_rule.hpp"
#include "scene/occluding_patches.hpp"

namespace fluxel {

namespace {

/// Faces that share a list of what may stand between them and those of another cluster.
constexpr std::size_t kClusterFaces = 32;

/// The shafts' epsilon over the scene's extent: walls nearer than this to a face count as part of it.
constexpr double kShaftEpsilon = 1e-10;

Box united(const Box& a, const Box& b) { return {glm::min(a.low, b.low), glm::max(a.high, b.high)}; }

enum class Place { in_front, behind, across };

/// Where a polygon lies of a plane; corners within `tolerance` lie in it.
Place place_of(const SmallPolygon& polygon, const Plane& plane, double tolerance) {
  double low = 0, high = 0;
  for (const glm::dvec3& corner : polygon) {
    const double height = plane.distance(corner);
    low = std::min(low, height);
    high = std::max(high, height);
  }
  if (high <= tolerance) return Place::behind;
  return low >= -tolerance ? Place::in_front : Place::across;
}

/// Adds up equal neighbours among the entries from `first` on.
void sum_equal(std::vector<SurfaceExchange>& list, std::size_t first) {
  std::size_t sums = first;
  for (std::size_t k = first; k < list.size(); ++k) {
    SurfaceExchange* const sum = sums > first ? &list[sums - 1] : nullptr;
    if (sum != nullptr && sum->from == list[k].from && sum->to == list[k].to)
      *sum += list[k];
    else
      list[sums++] = list[k];
  }
  list.resize(sums);
}

/// The surface of its group that a patch's surface is part of.
std::uint32_t surface_of_group(const Scene& scene, std::size_t surface_of_patch) {
  const Patch& patch = scene.patches[surface_of_patch / 2];
  return surface_of(static_cast<std::uint32_t>(patch.group), surface_of_patch % 2 == 1);
}

}  // namespace

SurfaceExchange& SurfaceExchange::operator+=(const SurfaceExchange& other) {
  G += other.G;
  error += other.error;
  deviation = std::hypot(deviation, other.deviation);
  return *this;
}

FacePairs::FacePairs(const RayScene& ray_scene, const Scene& scene, double tolerance, SurfacesOf surfaces)
    : scene_(scene),
      occlusion_(ray_scene, occluding_patches(scene), kShaftEpsilon * scene.extent),
      tolerance_(tolerance),
      surfaces_(surfaces) {
  for (const Piece& piece : scene.pieces)
    for (std::uint32_t side = 0; side < 2; ++side)
      if ((scene.patch(piece.patch).sides >> side & 1u) != 0) add_face(piece, side);
  for (std::size_t first = 0; first < faces_.size(); first += kClusterFaces) {
    Cluster cluster{first, std::min(first + kClusterFaces, faces_.size()), faces_[first].box};
    for (std::size_t k = first; k < cluster.last; ++k) cluster.box = united(cluster.box, faces_[k].box);
    clusters_.push_back(cluster);
  }
}

void FacePairs::add_face(const Piece& piece, std::uint32_t side) {
  const Patch& patch = scene_.patch(piece.patch);
  const PolygonView outline = corners(piece.outline);
  const auto number = surfaces_ == SurfacesOf::groups ? static_cast<std::uint32_t>(patch.group)
                                                      : static_cast<std::uint32_t>(piece.patch);
  Face face{{}, {}, bounds(outline), piece.patch, surface_of(number, side == 1)};
  face.polygon = {{outline.begin(), outline.end()}, patch.normal};
  if (side == 1) {
    std::ranges::reverse(face.polygon.corners);
    face.polygon.normal = -patch.normal;
  }
  face.shape = {centroid(outline), face.polygon.normal, area(outline), second_moments(piece.outline)};
  faces_.push_back(face);
}

std::size_t FacePairs::pairs_of_row(std::size_t row) const {
  const std::size_t of_row = clusters_[row].last - clusters_[row].first;
  return of_row * (of_row - 1) / 2 + of_row * (faces_.size() - clusters_[row].last);
}

SurfaceExchanges FacePairs::examine_row(std::size_t row,
                                        const std::function<void(std::size_t)>& looked_at) const {
  constexpr std::size_t kMaxUnreported = 1024;
  std::size_t unreported = 0;
  SurfaceExchanges found;
  std::vector<PatchId> candidates;
  const Cluster& of_row = clusters_[row];
  for (std::size_t column = row; column < clusters_.size(); ++column) {
    const Cluster& of_column = clusters_[column];
    candidates.clear();
    if (!occlusion_.occluders.patches.empty())
      occlusion_.tree.candidates(Shaft(of_row.box, of_column.box), occlusion_.epsilon, candidates);
    for (std::size_t a = of_row.first; a < of_row.last; ++a) {
      for (std::size_t b = row == column ? a + 1 : of_column.first; b < of_column.last; ++b) {
        ++unreported;
        if (faces_[a].patch == faces_[b].patch) continue;
        const Exchange exchange = examine_pair(a, b, candidates);
        if (!std::isfinite(exchange.total_error()) || !std::isfinite(exchange.G))
          throw std::logic_error("the exchange of two faces is no number");
        const auto [from, to] = std::minmax(faces_[a].surface, faces_[b].surface);
        if (exchange.G > 0)
          found.list.push_back({from, to, exchange.G, static_cast<float>(exchange.error),
                                static_cast<float>(std::sqrt(exchange.variance))});
        found.rays += exchange.rays;
        const bool took_long = exchange.rays > 0 || exchange.variance > 0;
        if (took_long || unreported >= kMaxUnreported) looked_at(std::exchange(unreported, 0));
      }
    }
  }
  if (unreported > 0) looked_at(unreported);
  found.list = sum_by_surfaces(std::move(found.list));
  found.list.shrink_to_fit();  // it may be kept until all rows are there
  return found;
}

Exchange FacePairs::examine_pair(std::size_t a, std::size_t b, std::span<const PatchId> candidates) const {
  const Face &face_a = faces_[a], &face_b = faces_[b];
  const Plane plane_a{face_a.shape.centroid, face_a.polygon.normal};
  const Plane plane_b{face_b.shape.centroid, face_b.polygon.normal};
  const Place place_a = place_of(face_a.polygon.corners, plane_b, occlusion_.epsilon);
  if (place_a == Place::behind) return {};
  const Place place_b = place_of(face_b.polygon.corners, plane_a, occlusion_.epsilon);
  if (place_b == Place::behind) return {};

  const double least = std::min(face_a.shape.area, face_b.shape.area);
  const bool whole = place_a == Place::in_front && place_b == Place::in_front;
  const double factor = pair_form_factor(PairRule::moments, face_a.shape, face_b.shape);
  const double G = face_a.shape.area * factor;
  const double whole_error = std::max(G, kMinFactor * least);
  // Quadrature errs on one side for many pairs of a row, rays at random: hence the smaller part.
  constexpr double kQuadraturePart = 0.3;
  const ExchangeTolerance tolerance{kQuadraturePart * tolerance_ * whole_error,
                                    std::sqrt(kSampledTolerance * tolerance_) * whole_error};
  const std::uint64_t seed = std::uint64_t{a} << 32 | b;
  if (whole) {
    const double error = moments_error(face_a.shape, face_b.shape) * least;
    const auto by_moments =
        error <= tolerance.quadrature ? std::optional(Exchange{G, error, 0, 0}) : std::nullopt;
    return exchange_past(occlusion_, {face_a.polygon, face_b.polygon, candidates, seed}, tolerance,
                         by_moments);
  }
  const SampledPolygon P{clip_to_front(corners(face_a.polygon.corners), plane_b, occlusion_.epsilon),
                         face_a.polygon.normal};
  const SampledPolygon Q{clip_to_front(corners(face_b.polygon.corners), plane_a, occlusion_.epsilon),
                         face_b.polygon.normal};
  return exchange_past(occlusion_, {P, Q, candidates, seed}, tolerance);
}

std::vector<double> FacePairs::surface_areas() const {
  const std::size_t count = surfaces_ == SurfacesOf::groups ? scene_.groups.size() : scene_.patches.size();
  std::vector<double> areas(2 * count, 0.0);
  for (const Face& face : faces_) areas[face.surface] += face.shape.area;
  return areas;
}

std::vector<double> areas_of_groups(const Scene& scene, std::span<const double> of_patches) {
  std::vector<double> areas(2 * scene.groups.size(), 0.0);
  for (std::size_t k = 0; k < of_patches.size(); ++k) areas[surface_of_group(scene, k)] += of_patches[k];
  return areas;
}

std::vector<SurfaceExchange> exchange_of_groups(const Scene& scene,
                                                std::span<const SurfaceExchange> of_patches) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, SurfaceExchange>
      sums;  // a sort of them all would take longer
  for (const SurfaceExchange& entry : of_patches) {
    const std::uint32_t one = surface_of_group(scene, entry.from), other = surface_of_group(scene, entry.to);
    const auto [from, to] = std::minmax(one, other);
    sums.try_emplace({from, to}, SurfaceExchange{from, to}).first->second += entry;
  }
  std::vector<SurfaceExchange> list;
  list.reserve(sums.size());
  for (const auto& [surfaces, sum] : sums) list.push_back(sum);
  return list;
}

std::vector<SurfaceExchange> sum_by_surfaces(std::vector<SurfaceExchange> list) {
  std::ranges::stable_sort(list, {},
                           [](const SurfaceExchange& entry) { return std::pair(entry.from, entry.to); });
  sum_equal(list, 0);
  return list;
}

std::vector<SurfaceExchange> merge_sums(std::span<const std::vector<SurfaceExchange>> lists) {
  std::size_t count = 0;
  std::uint32_t last = 0;
  for (const std::vector<SurfaceExchange>& list : lists) {
    count += list.size();
    if (!list.empty()) last = std::max(last, list.back().from);
  }
  std::vector<SurfaceExchange> merged;
  merged.reserve(count);
  std::vector<std::size_t> next(lists.size(), 0);
  for (std::uint32_t from = 0; from <= last; ++from) {
    const std::size_t first = merged.size();
    for (std::size_t k = 0; k < lists.size(); ++k)
      for (; next[k] < lists[k].size() && lists[k][next[k]].from == from; ++next[k])
        merged.push_back(lists[k][next[k]]);
    std::ranges::stable_sort(merged.begin() + static_cast<std::ptrdiff_t>(first), merged.end(), {},
                             &SurfaceExchange::to);
    sum_equal(merged, first);
  }
  return merged;
}

}  // namespace fluxel
