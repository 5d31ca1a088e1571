#include "method/audit_places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>

#include "core/morton.hpp"
#include "core/sampling.hpp"
#include "sampling/owen_sobol.hpp"
#include "scene/polygon.hpp"
#include "subdivision/subdivide.hpp"

namespace fluxel {

namespace {

constexpr std::size_t kPlaces = 2048;

/// The picture's regions, along each axis.
constexpr std::size_t kRegions = 8;

/// How near an edge a place may be [surface epsilons].
constexpr double kNearEdge = 4;

/// Smaller parts are not looked at on their own.
constexpr double kLeastShare = 0.01;
constexpr double kLeastPlaces = 16;

SurfacePlace place_of(const Scene& scene, PatchId id, bool front, const glm::dvec3& point, bool thermal) {
  const SideLight side = side_light(scene, id, front);
  const glm::dvec3& normal = scene.patch(id).normal;
  return {
      {point, front ? normal : -normal}, id, front, thermal ? Rgb(0) : side.E, thermal ? Rgb(1) : side.rho};
}

/// Of a point in an outline's plane, from the lines of its edges.
double distance_to_edges(const Outline<glm::dvec3>& outline, const glm::dvec3& point) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < outline.corners; ++k) {
    const glm::dvec3& corner = outline.corner[k];
    const glm::dvec3 edge = outline.corner[(k + 1) % outline.corners] - corner;
    least = std::min(least, glm::length(glm::cross(edge, point - corner)) / glm::length(edge));
  }
  return least;
}

/// Those of the parts that are large enough.
void add_parts(const std::map<std::string, std::vector<std::uint32_t>>& parts, AuditSubject& subject) {
  const double least = std::max(kLeastPlaces, kLeastShare * static_cast<double>(subject.places.size()));
  for (const auto& [name, places] : parts)
    if (static_cast<double>(places.size()) >= least) subject.parts.push_back({name, places});
}

void add_groups(const Scene& scene, AuditSubject& subject) {
  std::map<std::string, std::vector<std::uint32_t>> groups;
  for (std::uint32_t k = 0; k < subject.places.size(); ++k)
    groups[scene.groups[index(scene.patch(subject.places[k].patch).group)]].push_back(k);
  add_parts(groups, subject);
}

}  // namespace

std::vector<PicturePlace> draw_picture_places(const RayScene& ray_scene, const Camera& camera,
                                              int supersample, const Raster& raster) {
  const Scene& scene = ray_scene.scene();
  const double near = kNearEdge * static_cast<double>(ray_scene.surface_epsilon());
  std::vector<SeenPoint> seen = seen_points(scene, camera, supersample, raster);
  const auto light_of = [&](const SeenPoint& point) {
    return side_light(scene, point.patch, raster.front[point.pixel] != 0);
  };
  std::erase_if(seen, [&](const SeenPoint& point) {
    const SideLight side = light_of(point);
    return !side.active || side.rho == Rgb(0) ||
           distance_to_edges(scene.patch(point.patch).outline, point.point) < near;
  });
  // What lamps emit is known, and would hide the rest; but where all that is seen emits, that is looked at.
  const auto emits = [&](const SeenPoint& point) { return light_of(point).E != Rgb(0); };
  if (!std::ranges::all_of(seen, emits)) std::erase_if(seen, emits);
  // Steps of the golden ratio meet every part of the raster alike. The first ones are those of the error
  // control; what judges it is others.
  if (seen.size() > kPlaces) {
    std::vector<SeenPoint> chosen;
    for (std::size_t k = 0; k < kPlaces; ++k) {
      const double at = 0.6180339887498949 * static_cast<double>(kPlaces + k);
      chosen.push_back(
          seen[static_cast<std::size_t>((at - std::floor(at)) * static_cast<double>(seen.size()))]);
    }
    seen = std::move(chosen);
  }
  const auto width = static_cast<std::size_t>(raster.width), height = static_cast<std::size_t>(raster.height);
  std::ranges::stable_sort(seen, {}, [&](const SeenPoint& point) {
    return morton(static_cast<std::uint32_t>((point.pixel % width << 16) / width),
                  static_cast<std::uint32_t>((point.pixel / width << 16) / height));
  });
  std::vector<PicturePlace> places;
  places.reserve(seen.size());
  for (const SeenPoint& point : seen)
    places.push_back({place_of(scene, point.patch, raster.front[point.pixel] != 0, point.point, false),
                      static_cast<std::uint32_t>(point.pixel)});
  return places;
}

AuditSubject audit_picture(const Scene& scene, std::span<const PicturePlace> places, const Camera& camera,
                           int supersample) {
  const auto width = static_cast<std::size_t>(supersample) * static_cast<std::size_t>(camera.width);
  const auto height = static_cast<std::size_t>(supersample) * static_cast<std::size_t>(camera.height);
  AuditSubject subject;
  std::map<std::string, std::vector<std::uint32_t>> regions;
  for (const PicturePlace& place : places) {
    const std::string name =
        fmt::format("row {}, column {} of {} x {}", 1 + place.pixel / width * kRegions / height,
                    1 + place.pixel % width * kRegions / width, kRegions, kRegions);
    regions[name].push_back(static_cast<std::uint32_t>(subject.places.size()));
    subject.places.push_back(place.place);
  }
  add_parts(regions, subject);
  add_groups(scene, subject);
  return subject;
}

AuditSubject audit_surfaces(const Scene& scene, bool thermal) {
  struct Side {
    const Piece* piece;
    bool front;
  };
  std::vector<Side> sides;
  std::vector<double> ends;  // running sums of areas
  double area_so_far = 0;
  for (const Piece& piece : scene.pieces)
    for (const bool front : {true, false}) {
      const SideLight side = side_light(scene, piece.patch, front);
      if (!side.active || (!thermal && side.rho == Rgb(0))) continue;
      area_so_far += area(corners(piece.outline));
      sides.push_back({&piece, front});
      ends.push_back(area_so_far);
    }
  AuditSubject subject;
  if (sides.empty()) return subject;
  for (std::uint32_t k = 0; k < kPlaces; ++k) {
    const auto [within, u, v, unused] = OwenSobol(kPlaces, k).next();
    const double at = (k + within) / kPlaces * area_so_far;
    const auto found = std::ranges::upper_bound(ends, at) - ends.begin();
    const Side& side = sides[std::min(static_cast<std::size_t>(found), sides.size() - 1)];
    subject.places.push_back(
        place_of(scene, side.piece->patch, side.front, surface_point(side.piece->outline, u, v), thermal));
  }
  add_groups(scene, subject);
  return subject;
}

}  // namespace fluxel
