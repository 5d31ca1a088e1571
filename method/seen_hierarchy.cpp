#include "method/seen_hierarchy.hpp"

#include <algorithm>
#include <bit>

#include "core/options.hpp"
#include "hierarchy/link_hierarchy.hpp"
#include "hierarchy/ray_hierarchy.hpp"
#include "method/handle_signals.hpp"
#include "method/probes.hpp"
#include "mpi_master/communication/communicator_ranks.hpp"

namespace fluxel {

namespace {

OracleParts oracle_parts(const Options& options) {
  const Oracle oracle = options.oracle;
  return {oracle == Oracle::all || oracle == Oracle::power,
          oracle == Oracle::all || oracle == Oracle::importance, options.thermal};
}

/// Rays serve pictures and receivers: what a single node receives by them is noisy. Their cost hardly depends
/// on the faces, of which links between so many make pictures slow, and between very many are too coarse or
/// too many even where links are to be kept.
bool goes_by_rays(const Problem& problem) {
  constexpr std::size_t kManyFaces = 600, kVeryManyFaces = 20000;
  const Options& options = problem.options;
  if (options.exchange != ExchangeBy::automatic) return options.exchange == ExchangeBy::rays;
  std::size_t faces = 0;
  for (const Piece& piece : problem.scene.pieces)
    faces += static_cast<std::size_t>(std::popcount(problem.scene.patch(piece.patch).sides));
  return error_is_of_picture(options) && faces > (options.keep_links ? kVeryManyFaces : kManyFaces);
}

std::unique_ptr<Hierarchy> make_hierarchy(const Problem& problem, bool by_rays) {
  if (by_rays)
    return std::make_unique<RayHierarchy>(ranks_of(problem.world), problem.scene, problem.ray_scene,
                                          problem.threads, oracle_parts(problem.options));
  return std::make_unique<LinkHierarchy>(ranks_of(problem.world), problem.scene, problem.ray_scene,
                                         problem.threads, oracle_parts(problem.options));
}

/// Of a picture by records, over all of its pixels: by links 0.35 at most, by rays with a filter 0.25 to 0.4.
/// By links, so many points for the records of a large picture, and this part of its pixels for what is
/// emitted.
constexpr double kCached = 0.35, kRecords = 6000, kEmitted = 0.12;

}  // namespace

double work_of_picture(const Options& options, const SeenHierarchy& seen) {
  if (options.picture == PictureFrom::elements) return 1;
  const auto pixels = static_cast<double>(seen.points.size());
  if (options.picture != PictureFrom::cached) return pixels;
  return seen.by_rays ? kCached * pixels : std::min(kCached * pixels, kRecords + kEmitted * pixels);
}

SeenHierarchy see_hierarchy(const Problem& problem, const Raster& raster) {
  const Options& options = problem.options;
  SeenHierarchy seen;
  seen.by_rays = goes_by_rays(problem);
  seen.hierarchy = make_hierarchy(problem, seen.by_rays);
  const NodeTree& tree = seen.hierarchy->tree();
  if (options.camera) seen.points = seen_points_of(tree, *options.camera, options.supersample, raster);
  // The table of heat is of all surfaces, whatever a camera sees.
  if (error_is_of_picture(options)) seen.probe_pixels = choose_probes(tree, seen.points);
  seen.probes.reserve(seen.probe_pixels.size());
  for (const std::uint32_t pixel : seen.probe_pixels) seen.probes.push_back(seen.points[pixel]);
  seen.hierarchy->set_importance_points(seen.probes);
  seen.hierarchy->handle_signals_by(
      [&problem] { handle_signals(problem.world, problem.options, problem.log); });
  return seen;
}

}  // namespace fluxel
