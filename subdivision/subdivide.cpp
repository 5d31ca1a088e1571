#include "subdivision/subdivide.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "subdivision/add_element.hpp"
#include "subdivision/bisection.hpp"
#include "subdivision/camera_raster.hpp"

namespace fluxel {

namespace {

/// Distance [m] of a point of the patch's plane from the piece's outline, positive inside.
double depth_inside(const Outline3& outline, const glm::dvec3& normal, const glm::dvec3& point) {
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t c = 0; c < outline.corners; ++c) {
    const glm::dvec3 from = outline.corner[c];
    const glm::dvec3 along = glm::normalize(outline.corner[(c + 1) % outline.corners] - from);
    least = std::min(least, glm::dot(glm::cross(normal, along), point - from));
  }
  return least;
}

}  // namespace

PieceFinder::PieceFinder(const Scene& scene)
    : scene_(scene), first_(scene.patches.size()), count_(scene.patches.size()) {
  for (std::size_t piece = 0; piece < scene.pieces.size(); ++piece) {
    const std::size_t patch = index(scene.pieces[piece].patch);
    if (count_[patch]++ == 0) first_[patch] = static_cast<std::uint32_t>(piece);
  }
}

std::size_t PieceFinder::find(PatchId patch, const glm::dvec3& point) const {
  const std::size_t first = first_[index(patch)], last = first + count_[index(patch)];
  if (last - first == 1) return first;
  std::size_t best = first;
  double best_depth = -std::numeric_limits<double>::infinity();
  for (std::size_t piece = first; piece < last; ++piece) {
    const double depth = depth_inside(scene_.pieces[piece].outline, scene_.patch(patch).normal, point);
    if (depth > best_depth) {
      best = piece;
      best_depth = depth;
    }
  }
  return best;
}

double piece_area(const Scene& scene) {
  double total = 0;
  for (const Piece& piece : scene.pieces) total += area(piece.outline);
  return total;
}

double default_max_edge(const Scene& scene, std::size_t pixels_that_see) {
  return std::sqrt(16 * piece_area(scene) / static_cast<double>(std::max<std::size_t>(pixels_that_see, 1)));
}

SubdividedPieces subdivide_pieces(const Scene& scene, std::size_t first_piece, std::size_t last_piece,
                                  std::span<const SeenPoint> seen, const SplitCriterion& criterion) {
  const PieceFinder finder(scene);
  std::vector<std::vector<PixelPoint>> pixels(last_piece - first_piece);
  for (const SeenPoint& at : seen) {
    const std::size_t piece = finder.find(at.patch, at.point);
    if (piece >= first_piece && piece < last_piece)
      pixels[piece - first_piece].push_back({at.pixel, at.point});
  }

  SubdividedPieces result;
  std::vector<Leaf> leaves;
  for (std::size_t piece = first_piece; piece < last_piece; ++piece) {
    leaves.clear();
    bisect_until(scene.pieces[piece].outline, std::move(pixels[piece - first_piece]), criterion.max_pixels,
                 criterion.max_edge, leaves);
    for (const Leaf& leaf : leaves) {
      const auto element = static_cast<std::uint32_t>(result.mesh.elements.size());
      for (const std::size_t pixel : leaf.pixels) {
        result.pixels.push_back(pixel);
        result.pixel_element.push_back(element);
      }
      add_element(scene, scene.pieces[piece].patch, leaf.outline, result.mesh);
      result.max_depth = std::max(result.max_depth, leaf.depth);
    }
  }
  return result;
}

std::vector<SeenPoint> seen_points(const Scene& scene, const Camera& camera, int supersample,
                                   const Raster& raster) {
  const PixelRays rays(camera, supersample);
  std::vector<SeenPoint> points;
  for (std::size_t pixel = 0; pixel < raster.pixels(); ++pixel)
    if (raster.patch[pixel] != kNoPatch)
      points.push_back({pixel, raster.patch[pixel], pixel_point(scene, camera, rays, raster, pixel)});
  return points;
}

std::vector<std::size_t> split_pieces(const Scene& scene, std::size_t parts) {
  std::vector<std::size_t> first(parts + 1, scene.pieces.size());
  for (std::size_t part = 0; part < parts; ++part) {
    std::size_t piece = scene.pieces.size() * part / parts;
    while (piece > 0 && piece < scene.pieces.size() &&
           scene.pieces[piece].patch == scene.pieces[piece - 1].patch)
      ++piece;
    first[part] = piece;
  }
  return first;
}

}  // namespace fluxel
