#include "bench/gpu_check/paths.hpp"

#include <cinttypes>
#include <cmath>
#include <cstdio>

#include "bench/gpu_check/chance.hpp"
#include "bench/gpu_check/json.hpp"
#include "bench/gpu_check/stopwatch.hpp"
#include "bench/gpu_check/tiles.hpp"
#include "reference/cuda/device_paths.hpp"
#include "reference/cuda/light_path.hpp"
#include "reference/cuda/same_path.hpp"
#include "visibility/cuda/verified_counts.hpp"

namespace fluxel::cuda::checks {

namespace {

constexpr double kEmitted = 1, kReflectance = 0.5, kKnown = kEmitted / (1 - kReflectance);

/// The mean of right estimates is farther off in one check of 16,000.
constexpr double kMostErrors = 4;

/// Digits by chance do for Sobol's: host and device have the same.
SobolDirections any_directions(Chance& chance) {
  SobolDirections directions{};
  for (auto& byte : directions.digits)
    for (auto& value : byte)
      for (std::uint32_t& axis : value) axis = chance.below(0xFFFFFFFFu);
  return directions;
}

PathArrays arrays_for_paths(const CheckScene& scene, Chance& chance) {
  PathArrays arrays{arrays_of(scene, 1), {}, {}, {}, {}, {any_directions(chance)}};
  arrays.flags.assign(scene.patches.size(), kActiveFront | kEmitter);
  const Double3 E{kEmitted, kEmitted, kEmitted}, rho{kReflectance, kReflectance, kReflectance};
  double sum = 0;
  for (const ExactPatch& patch : scene.patches) {
    arrays.sides.push_back({rho, E});
    arrays.sides.push_back({{0, 0, 0}, {0, 0, 0}});
    EmittingSide& emitter = arrays.emitters.emplace_back();
    for (std::uint32_t c = 0; c < 4; ++c) emitter.corner[c] = patch.corner[c];
    emitter.normal = patch.normal;
    emitter.E = E;
    emitter.corners = patch.corners;
    const double parallelogram =
        length(cross(patch.corner[1] - patch.corner[0], patch.corner[patch.corners - 1] - patch.corner[0]));
    arrays.emitter_ends.push_back(sum += 3 * kEmitted * (patch.corners == 4 ? 1 : 0.5) * parallelogram);
  }
  return arrays;
}

std::vector<PathBegin> paths_from(const CheckScene& scene, std::size_t count, Chance& chance) {
  std::vector<PathBegin> paths;
  paths.reserve(count);
  for (std::uint32_t k = 0; k < count; ++k) {
    const ExactPatch& patch = scene.patches[chance.below(static_cast<std::uint32_t>(scene.patches.size()))];
    const double s = chance.between(0, 1), t = chance.between(0, 1);
    const double u = chance.between(0, 1), v = chance.between(0, 1);
    paths.push_back(
        {surface_point(patch.corner, patch.corners, s, t), patch.normal, {u, v}, {random_bits(k), k, 0}});
  }
  return paths;
}

std::uint64_t rays_of(const std::vector<PathEstimate>& found) {
  std::uint64_t rays = 0;
  for (const PathEstimate& path : found) rays += path.rays;
  return rays;
}

double mean_of(const std::vector<PathEstimate>& found) {
  double sum = 0;
  for (const PathEstimate& path : found) sum += path.irradiance.x;
  return sum / static_cast<double>(found.size());
}

std::vector<PathEstimate> follow_on_host(const PathScene& scene, const std::vector<PathBegin>& paths,
                                         unsigned threads) {
  std::vector<PathEstimate> found(paths.size());
  in_parallel(paths.size(), threads, [&](std::size_t k) { found[k] = LightPath(scene, paths[k]).follow(); });
  return found;
}

bool differs(const PathEstimate& a, const PathEstimate& b) {
  return a.rays != b.rays || !is_same_path(a.irradiance, b.irradiance);
}

}  // namespace

bool PathFigures::right() const {
  return std::fabs(mean - 1) <= kMostErrors * error &&
         !differs_too_often({device_paths, device_paths, differing}, kMostDifferingPaths) &&
         std::fabs(change_of_mean) <= error;
}

PathFigures check_paths(const CheckScene& scene, std::size_t paths, int device, unsigned threads) {
  Chance chance;
  const PathArrays arrays = arrays_for_paths(scene, chance);
  const std::vector<PathBegin> begins = paths_from(scene, paths, chance);
  PathFigures figures;
  figures.scene = scene.name;
  figures.patches = scene.patches.size();
  figures.paths = paths;
  const std::vector<PathEstimate> found = follow_on_host(arrays.view(), begins, threads);
  double squares = 0;
  for (const PathEstimate& path : found) squares += std::pow(path.irradiance.x / kKnown, 2);
  const auto count = static_cast<double>(paths);
  figures.mean = mean_of(found) / kKnown;
  figures.error = std::sqrt((squares / count - figures.mean * figures.mean) / count);

  const std::vector<PathBegin> timed(begins.begin(),
                                     begins.begin() + static_cast<std::ptrdiff_t>(paths / 10));
  const Stopwatch on_host;
  const std::uint64_t timed_rays = rays_of(follow_on_host(arrays.view(), timed, 1));
  figures.host_rays_per_second = static_cast<double>(timed_rays) / on_host.seconds();
  if (device < 0) return figures;

  DevicePaths follower(arrays, device, free_memory_of(device));
  static_cast<void>(follower.follow(begins));  // a device that idled is slow
  const double kernel_before = follower.seconds().kernel;
  const Stopwatch on_device;
  const std::vector<PathEstimate> of_device = follower.follow(begins);
  const auto rays = static_cast<double>(rays_of(of_device));
  figures.device_rays_per_second = rays / on_device.seconds();
  figures.kernel_rays_per_second = rays / (follower.seconds().kernel - kernel_before);
  figures.device_paths = paths;
  for (std::size_t k = 0; k < paths; ++k) figures.differing += differs(found[k], of_device[k]) ? 1 : 0;
  figures.change_of_mean = mean_of(of_device) / mean_of(found) - 1;
  return figures;
}

void print_paths(const std::vector<PathFigures>& figures) {
  std::printf(
      "\npaths of light in rooms of known irradiance; rays in millions a second, the host's by one "
      "core\n%-18s %8s %9s %9s %9s %9s %7s %9s %8s %8s %8s\n",
      "scene", "patches", "paths", "mean", "error", "on GPU", "differ", "change", "host", "GPU", "kernel");
  for (const PathFigures& row : figures)
    std::printf("%-18s %8zu %9" PRIu64 " %9.5f %9.2g %9" PRIu64 " %7" PRIu64 " %9.2g %8.3g %8.4g %8.4g%s\n",
                row.scene.c_str(), row.patches, row.paths, row.mean, row.error, row.device_paths,
                row.differing, row.change_of_mean, 1e-6 * row.host_rays_per_second,
                1e-6 * row.device_rays_per_second, 1e-6 * row.kernel_rays_per_second,
                row.right() ? "" : "  WRONG");
}

std::string to_json(const std::vector<PathFigures>& figures) {
  const auto count = [](std::uint64_t value) { return json::number(static_cast<double>(value)); };
  std::vector<std::string> all;
  all.reserve(figures.size());
  for (const PathFigures& row : figures)
    all.push_back(json::object({{"scene", json::text(row.scene)},
                                {"patches", count(row.patches)},
                                {"paths", count(row.paths)},
                                {"mean", json::number(row.mean)},
                                {"error", json::number(row.error)},
                                {"device_paths", count(row.device_paths)},
                                {"differing", count(row.differing)},
                                {"change_of_mean", json::number(row.change_of_mean)},
                                {"host_rays_per_second", json::number(row.host_rays_per_second)},
                                {"device_rays_per_second", json::number(row.device_rays_per_second)},
                                {"kernel_rays_per_second", json::number(row.kernel_rays_per_second)}}));
  return json::list(all);
}

}  // namespace fluxel::cuda::checks
