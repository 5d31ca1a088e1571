#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/camera.hpp"
#include "core/element.hpp"
#include "core/raster.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// When a node of a patch's tree is split.
struct SplitCriterion {
  std::size_t max_pixels = std::numeric_limits<std::size_t>::max();  ///< that a leaf may own
  double max_edge = std::numeric_limits<double>::infinity();         ///< that a leaf may have [m]
};

/// Default of --max-edge with camera subdivision: with P pixels that see a surface and A the area of all
/// pieces, sqrt(16 A / P). Rectangles are split to edges between half of it and itself, triangles to about a
/// sixth of its square in area, so that what the camera does not see gets about P / 8 elements of rectangles
/// or P / 3 of triangles if it is all of the scene, less in proportion, and at least one a piece.
[[nodiscard]] double default_max_edge(const Scene& scene, std::size_t pixels_that_see);

/// Total area of the pieces [m2].
[[nodiscard]] double piece_area(const Scene& scene);

/// Elements of a range of pieces, in the order of the unknowns.
struct SubdividedPieces {
  ElementMesh mesh;
  std::vector<std::size_t> pixels;           ///< that see one of these pieces' patches
  std::vector<std::uint32_t> pixel_element;  ///< for each of them, its element: a place in `mesh`
  int max_depth = 0;                         ///< steps of the deepest leaf
};

/// A pixel and the patch that it sees, with the point [m, recentred].
struct SeenPoint {
  std::size_t pixel = 0;
  PatchId patch = kNoPatch;
  glm::dvec3 point{0};
};

/// Splits the pieces [first_piece, last_piece), which hold all pieces of their patches. `seen` may have
/// points on other patches, which are passed over.
[[nodiscard]] SubdividedPieces subdivide_pieces(const Scene& scene, std::size_t first_piece,
                                                std::size_t last_piece, std::span<const SeenPoint> seen,
                                                const SplitCriterion& criterion);

/// The pixels of a raster that see a patch.
[[nodiscard]] std::vector<SeenPoint> seen_points(const Scene& scene, const Camera& camera, int supersample,
                                                 const Raster& raster);

/// First pieces of `parts` ranges that hold whole patches, balanced by the number of pieces; parts + 1
/// entries, ranges may be empty.
[[nodiscard]] std::vector<std::size_t> split_pieces(const Scene& scene, std::size_t parts);

}  // namespace fluxel
