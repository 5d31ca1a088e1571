#include "method/probes.hpp"

#include <cmath>

#include "scene/scene.hpp"
#include "subdivision/camera_raster.hpp"
#include "subdivision/piece_finder.hpp"
#include "subdivision/subdivide.hpp"

namespace fluxel {

namespace {

/// So many of the picture's pixels show how good it is.
constexpr std::size_t kProbes = 2048;

}  // namespace

std::vector<GatherPoint> seen_points_of(const NodeTree& tree, const Camera& camera, int supersample,
                                        const Raster& raster) {
  std::vector<GatherPoint> points(raster.pixels());
  const Scene& scene = tree.scene();
  const PieceFinder finder(scene);
  for (const SeenPoint& seen : seen_points(scene, camera, supersample, raster)) {
    const std::size_t piece = finder.find(seen.patch, seen.point);
    points[seen.pixel] = {tree.face(piece, raster.front[seen.pixel] != 0), seen.point};
  }
  return points;
}

std::vector<std::uint32_t> choose_probes(const NodeTree& tree, std::span<const GatherPoint> points) {
  const Scene& scene = tree.scene();
  std::vector<std::uint32_t> dark;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (points[k].face == kNoNode) continue;
    const PatchId patch = scene.pieces[tree[points[k].face].piece].patch;
    if (!scene.emits(patch) && scene.material(scene.patch(patch)).rho != Rgb(0))
      dark.push_back(static_cast<std::uint32_t>(k));
  }
  if (dark.size() <= kProbes) return dark;
  // Steps of the golden ratio meet every part of the raster alike.
  std::vector<std::uint32_t> chosen;
  for (std::size_t k = 0; k < kProbes; ++k) {
    const double at = 0.6180339887498949 * static_cast<double>(k);
    chosen.push_back(
        dark[static_cast<std::size_t>((at - std::floor(at)) * static_cast<double>(dark.size()))]);
  }
  return chosen;
}

}  // namespace fluxel
