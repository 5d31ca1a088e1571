#include "mpi_master/steps/subdivision_job.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "core/hash.hpp"
#include "core/options.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/host_gather.hpp"
#include "mpi_master/steps/forecast.hpp"
#include "scene/polygon.hpp"
#include "subdivision/camera_raster.hpp"
#include "subdivision/subdivide.hpp"

namespace fluxel {

namespace {

/// More than any machine holds, and few enough that their square is a number.
constexpr double kManyElements = 1e10;

/// Of the rasters, their claims and the points that they see, at their peak.
constexpr std::uint64_t kBytesPerPixel =
    2 * sizeof(double) + sizeof(PixelClaim) + 2 * sizeof(std::uint32_t) + 1 + 2 * sizeof(SeenPoint);

/// The pieces of one rank, as occluders and as roots.
struct SubScene {
  std::size_t first_piece, last_piece;
  std::vector<PatchId> patches;

  SubScene(const Communicator& communicator, const Scene& scene) {
    const auto bounds = split_pieces(scene, static_cast<std::size_t>(communicator.size()));
    first_piece = bounds[static_cast<std::size_t>(communicator.rank())];
    last_piece = bounds[static_cast<std::size_t>(communicator.rank()) + 1];
    for (std::size_t piece = first_piece; piece < last_piece; ++piece)
      if (patches.empty() || patches.back() != scene.pieces[piece].patch)
        patches.push_back(scene.pieces[piece].patch);
  }
};

struct Views {
  Raster merged;
  std::vector<SeenPoint> points;  ///< what this rank splits by
};

Views merge_views(const Communicator& communicator, const Scene& scene, const Options& options,
                  const SubScene& mine, int threads) {
  const Camera& camera = *options.camera;
  const RayScene part(scene, mine.patches, threads);
  std::vector<double> nearest = nearest_depths(part, scene, camera, options.supersample, threads);
  std::vector<PixelClaim> own_claims;
  if (options.subscenes == Subscenes::independent)
    own_claims = claim_pixels(part, scene, camera, options.supersample, nearest, threads);
  communicator.all_min(nearest);
  std::vector<PixelClaim> claims = claim_pixels(part, scene, camera, options.supersample, nearest, threads);
  communicator.all_min(claims);

  Views views;
  views.merged = make_raster(scene, camera, options.supersample, claims);
  views.points = seen_points(scene, camera, options.supersample, views.merged);
  if (options.subscenes == Subscenes::independent) {
    const Raster own = make_raster(scene, camera, options.supersample, own_claims);
    for (const SeenPoint& point : seen_points(scene, camera, options.supersample, own))
      if (views.merged.patch[point.pixel] != point.patch) views.points.push_back(point);
  }
  return views;
}

/// A lower bound of the elements by longest edge alone: none is larger than the square of it, and along a
/// piece's own edges none reaches further than it.
double least_elements_by_edge(const Scene& scene, double max_edge) {
  double least = 0;
  for (const Piece& piece : scene.pieces) {
    const PolygonView corner = corners(piece.outline);
    double longest = 0;
    for (std::size_t c = 0; c < corner.size(); ++c)
      longest = std::max(longest, glm::distance(corner[c], corner[(c + 1) % corner.size()]));
    least += std::max(area(corner) / (max_edge * max_edge), longest / max_edge);
  }
  return least;
}

/// Of the rank that has most, which has an even share at least; and once more what its host has of all.
std::uint64_t bytes_of_elements(const Communicator& communicator, std::size_t elements) {
  constexpr std::uint64_t kBytes = sizeof(Element) + sizeof(Outline<glm::vec3>);
  return kBytes * (elements / static_cast<std::size_t>(communicator.size()) +
                   elements / static_cast<std::size_t>(communicator.host().size()));
}

}  // namespace

void share_elements(const Communicator& communicator, const ElementView& own, SubdividedScene& subdivided) {
  subdivided.elements = gather_on_hosts(communicator, own.elements);
  subdivided.outlines = gather_on_hosts(communicator, own.outlines);
  subdivided.mesh = {subdivided.elements.items(), subdivided.outlines.items()};
  subdivided.hash = hash_bytes(std::as_bytes(subdivided.mesh.outlines),
                               hash_bytes(std::as_bytes(subdivided.mesh.elements)));
}

SubdividedScene subdivide_scene(const Communicator& communicator, const Scene& scene, const Options& options,
                                int threads, const BytesOfElements& bytes_to_follow) {
  const SubScene mine(communicator, scene);
  SubdividedScene result;
  Views views;
  if (options.camera) {
    const PixelRays rays(*options.camera, options.supersample);
    const auto pixels = static_cast<std::uint64_t>(rays.width()) * static_cast<std::uint64_t>(rays.height());
    require_memory(communicator, pixels * kBytesPerPixel, "the raster", "use a smaller --resolution");
    views = merge_views(communicator, scene, options, mine, threads);
    agree(communicator, [&] { require_view(scene, views.merged); });
  }
  if (options.subdivision == Subdivision::transport) {
    result.raster = std::move(views.merged);
    return result;
  }

  SplitCriterion criterion;
  std::size_t least_elements = scene.pieces.size();
  if (options.subdivision == Subdivision::camera) {
    criterion.max_pixels = 1;
    const auto seeing = static_cast<std::size_t>(
        std::ranges::count_if(views.merged.patch, [](PatchId id) { return id != kNoPatch; }));
    criterion.max_edge = options.max_edge.value_or(default_max_edge(scene, seeing));
    least_elements = seeing;  // each of these pixels will have an element of its own
  } else if (options.subdivision == Subdivision::uniform) {
    criterion.max_edge = *options.max_edge;
  }
  result.max_edge = criterion.max_edge;
  // Bounds before any element is made.
  const double by_edge = least_elements_by_edge(scene, criterion.max_edge);
  least_elements = std::max(least_elements, static_cast<std::size_t>(std::min(by_edge, kManyElements)));
  require_memory(communicator, bytes_of_elements(communicator, least_elements), "the elements",
                 kFewerElements);
  if (bytes_to_follow)
    require_memory(communicator, bytes_to_follow(least_elements), "the visibility of the elements",
                   kFewerElements);

  SubdividedPieces own;
  agree(communicator,
        [&] { own = subdivide_pieces(scene, mine.first_piece, mine.last_piece, views.points, criterion); });

  // Ranks hold ascending pieces, so what is gathered in their order is the order of the unknowns.
  const std::uint64_t own_elements = own.mesh.elements.size();
  const auto counts = communicator.all_gather(std::span(&own_elements, 1));
  std::uint64_t before = 0;
  for (int rank = 0; rank < communicator.rank(); ++rank) before += counts[static_cast<std::size_t>(rank)];
  share_elements(communicator, own.mesh, result);

  result.raster = std::move(views.merged);
  std::vector<std::uint32_t> element(result.raster.pixels(), static_cast<std::uint32_t>(kNoElement));
  for (std::size_t k = 0; k < own.pixels.size(); ++k) {
    const std::size_t pixel = own.pixels[k];
    // With independent sub-scenes a pixel has an element in each; the picture shows the nearest.
    if (own.mesh.elements[own.pixel_element[k]].patch == result.raster.patch[pixel])
      element[pixel] = static_cast<std::uint32_t>(before) + own.pixel_element[k];
  }
  communicator.all_min(std::span(element));
  std::ranges::transform(element, result.raster.element.begin(),
                         [](std::uint32_t id) { return ElementId{id}; });

  auto max_depth = static_cast<double>(own.max_depth);
  communicator.all_max(std::span(&max_depth, 1));
  result.max_depth = static_cast<int>(max_depth);
  return result;
}

}  // namespace fluxel
