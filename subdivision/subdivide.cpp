#include "subdivision/subdivide.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "subdivision/add_element.hpp"
#include "subdivision/bisection.hpp"
#include "subdivision/camera_raster.hpp"
#include "subdivision/piece_finder.hpp"

namespace fluxel {

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
