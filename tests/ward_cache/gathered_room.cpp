#include "tests/ward_cache/gathered_room.hpp"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <utility>

#include "core/error.hpp"
#include "core/options.hpp"
#include "method/probes.hpp"
#include "method/subdivide.hpp"
#include "mpi_master/communication/communicator_ranks.hpp"

namespace fluxel::ward_cache {

namespace {

constexpr int kThreads = 1;

/// Of the rounds' links (see Hierarchy::refine): light that is off by about a percent.
constexpr std::array kBlockErrors{4e-3, 1e-3, 2.5e-4};

constexpr std::uint64_t kMuchMemory = std::uint64_t{1} << 40;

/// Of the rays for the truth and for records, which have none in common with each other nor with those of
/// gather_sparsely.
constexpr std::uint64_t kTruthSeed = 1, kRecordSeed = 2;

Scene scene_of(const SolveRequest& request) {
  if (!request.options.camera) throw InputError(request.input.name + " has no camera");
  SceneSettings settings{request.options.sides, request.options.ke, request.options.cut, std::nullopt};
  settings.camera_eye = request.options.camera->eye;
  settings.merge = request.options.merge;
  return build_scene(request.input, settings);
}

}  // namespace

GatheredRoom::GatheredRoom(const Communicator& world, const SolveRequest& request, double ray_error,
                           double finer)
    : options_(request.options),
      world_(world),
      scene_(scene_of(request)),
      ray_scene_(scene_, kThreads),
      first_side_(ray_scene_),
      pieces_(scene_),
      hierarchy_(ranks_of(world), scene_, ray_scene_, kThreads, {}),
      ray_error_(ray_error) {
  // 1. What the pixels see.
  const NodeTree& tree = hierarchy_.tree();
  options_.subdivision = Subdivision::transport;
  Solution solution;
  subdivide(problem(), {}, solution);
  points_ = seen_points_of(tree, *options_.camera, 1, solution.subdivided.raster);
  const std::vector<std::uint32_t> probe_pixels = choose_probes(tree, points_);
  std::vector<GatherPoint> probes;
  for (const std::uint32_t pixel : probe_pixels) probes.push_back(points_[pixel]);

  // 2. The solution.
  hierarchy_.set_importance_points(probes);
  for (const double error : kBlockErrors) {
    static_cast<void>(hierarchy_.refine(error, kMuchMemory, progress_));
    hierarchy_.solve(Solver::conjugate_gradients, {1e-4, 200}, [](const IterationState&) {});
  }
  B_ = hierarchy_.radiosity_of_nodes();
  for (NodeId node = 0; node < tree.size(); ++node)
    if (!tree.is_cluster(node)) B_[node] -= tree.emission(node);

  // 3. Its light at the pixels.
  seen_.resize(points_.size());
  for (std::uint32_t pixel = 0; pixel < points_.size(); ++pixel) {
    const NodeId face = points_[pixel].face;
    if (face == kNoNode) continue;
    seen_[pixel] = {points_[pixel].position, tree[face].shape.normal, tree[face].piece};
    if (tree.material(face).rho != Rgb(0) && tree.emission(face) == Rgb(0)) reflecting_.push_back(pixel);
  }
  const auto gather = [&](std::span<const GatherPoint> points, double error, std::uint64_t seed,
                          LightFrom from) {
    return hierarchy_.gather(points, {error, hierarchy_.mean_radiosity(), seed, from}, progress_);
  };
  truth_ = gather(points_, ray_error / finer, kTruthSeed, LightFrom::reflection);
  records_ = gather(points_, ray_error, kRecordSeed, LightFrom::reflection);
  const std::vector<Rgb> all = gather(probes, ray_error, kTruthSeed, LightFrom::everywhere);
  for (std::size_t k = 0; k < probes.size(); ++k)
    mean_ += tree.material(probes[k].face).rho * all[k] / static_cast<double>(probes.size());
}

Problem GatheredRoom::problem() {
  return {.world = world_,
          .scene = scene_,
          .ray_scene = ray_scene_,
          .sensors = {.camera = &*options_.camera},
          .options = options_,
          .threads = kThreads,
          .progress = progress_,
          .log = log_};
}

double GatheredRoom::error_of(std::span<const Rgb> irradiance) const {
  double squares = 0;
  for (const std::uint32_t pixel : reflecting_) {
    const Rgb& rho = hierarchy_.tree().material(points_[pixel].face).rho;
    const double off = mean_of_colours(rho * (irradiance[pixel] - truth_[pixel]));
    squares += off * off;
  }
  return std::sqrt(squares / static_cast<double>(reflecting_.size())) / mean_of_colours(mean_);
}

SparseLight GatheredRoom::gather_sparsely(double allowed) {
  return fluxel::gather_sparsely(problem(), hierarchy_, width(), points_, {ray_error_, allowed, mean_, 0});
}

HemisphereLight GatheredRoom::look_around(std::uint32_t pixel, const Strata& strata) const {
  const SidePoint& at = seen_[pixel];
  const glm::dvec3 lifted = at.position + static_cast<double>(ray_scene_.surface_epsilon()) * at.normal;
  return ward_cache::look_around(at.normal, strata,
                                 [&](const glm::dvec3& direction) { return look(lifted, direction); });
}

Sight GatheredRoom::look(const glm::dvec3& from, const glm::dvec3& direction) const {
  const MetSide met = first_side_.meet(from, direction);
  if (met.patch == kNoPatch) return {std::numeric_limits<double>::infinity(), Rgb(0)};
  const NodeTree& tree = hierarchy_.tree();
  const glm::dvec3 place = from + met.t * direction;
  const std::size_t piece = pieces_.find(met.patch, place);
  const NodeId face = met.active && piece != PieceFinder::kNone ? tree.face(piece, met.front) : kNoNode;
  return {met.t, face == kNoNode ? Rgb(0) : B_[tree.leaf_below(face, place)]};
}

double GatheredRoom::footprint(std::uint32_t pixel) const {
  const Camera& camera = *options_.camera;
  const glm::dvec3 sight = seen_[pixel].position - camera.eye;
  const double depth = glm::dot(sight, glm::normalize(camera.look_at - camera.eye));
  return depth * 2 * std::tan(camera.fov * std::numbers::pi / 360) / camera.height;
}

}  // namespace fluxel::ward_cache
