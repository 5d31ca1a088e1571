#include "bench/gpu_check/hits.hpp"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>

#include "bench/gpu_check/chance.hpp"
#include "bench/gpu_check/json.hpp"
#include "bench/gpu_check/stopwatch.hpp"
#include "bench/gpu_check/tiles.hpp"
#include "visibility/cuda/device_hits.hpp"

namespace fluxel::cuda::checks {

namespace {

constexpr std::uint64_t kMaxPrintedRays = 10;  // of a comparison's differences

/// To the bit, as both do the same operations.
bool equal(const NearestHit& a, const NearestHit& b) {
  return a.patch == b.patch && bits_of(a.t) == bits_of(b.t);
}

struct Compared {
  std::uint64_t hits = 0, differing = 0;
};

Compared compare(const char* scene, const char* against, const std::vector<NearestHit>& expected,
                 const std::vector<NearestHit>& found) {
  Compared compared;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    compared.hits += expected[k].patch != kNoHit ? 1 : 0;
    if (equal(expected[k], found[k]) || compared.differing++ >= kMaxPrintedRays) continue;
    std::printf("  %s, %s: ray %zu meets %" PRIu32 " at %.17g, but should meet %" PRIu32 " at %.17g\n", scene,
                against, k, found[k].patch, found[k].t, expected[k].patch, expected[k].t);
  }
  return compared;
}

template <class Find>
std::vector<NearestHit> all_hits(const std::vector<Ray>& rays, unsigned threads, const Find& find) {
  std::vector<NearestHit> hits(rays.size());
  in_parallel(rays.size(), threads, [&](std::size_t k) { hits[k] = find(rays[k]); });
  return hits;
}

/// How the k-th ray of a scene is made: all ways come in turn.
enum class Aim : std::uint8_t { anywhere, corner, edge, inside, axis, from_afar, corner_from_afar, past };
constexpr std::size_t kAims = 8;

class RayMaker {
 public:
  explicit RayMaker(const CheckScene& scene) : scene_(scene), extent_(static_cast<double>(scene.extent)) {}

  Ray make(Aim aim) {
    const Double3 near = point_within(extent_), direction = point_within(1);
    // Up to ten million times as far away as the scene is large.
    const Double3 afar = std::pow(10.0, chance_.between(1, 7)) * near;
    switch (aim) {
      case Aim::anywhere:
        return {near, direction};
      case Aim::corner:
        return through(near, point_of_patch(0, 0));
      case Aim::edge:
        return through(near, point_of_patch(chance_.between(0, 1), 0));
      case Aim::inside:
        return through(near, point_of_patch(chance_.between(0, 1), chance_.between(0, 0.5)));
      case Aim::axis: {
        // Through corners in the planes of others, where the scene stands on a lattice.
        const Double3 corner = point_of_patch(0, 0);
        const double step = chance_.below(2) == 0 ? 1 : -1;
        const Double3 along[3] = {{step, 0, 0}, {0, step, 0}, {0, 0, step}};
        const Double3& axis = along[chance_.below(3)];
        return {corner - extent_ * axis, axis};
      }
      case Aim::from_afar:
        return through(afar, point_of_patch(chance_.between(0, 1), chance_.between(0, 0.5)));
      case Aim::corner_from_afar:
        return through(afar, point_of_patch(0, 0));
      case Aim::past:
        break;
    }
    return {10.0 * near + Double3{0, 0, 20 * extent_}, {direction.x, direction.y, std::fabs(direction.z)}};
  }

 private:
  Double3 point_within(double reach) {
    const double x = chance_.between(-reach, reach), y = chance_.between(-reach, reach);
    return {x, y, chance_.between(-reach, reach)};
  }

  static Ray through(const Double3& origin, const Double3& point) { return {origin, point - origin}; }

  /// A share of the way along an edge, and from there of the way to the middle of the next one but one.
  Double3 point_of_patch(double along, double inwards) {
    const ExactPatch& patch =
        scene_.patches[chance_.below(static_cast<std::uint32_t>(scene_.patches.size()))];
    const std::uint32_t c = chance_.below(patch.corners);
    const auto corner = [&](std::uint32_t step) { return patch.corner[(c + step) % patch.corners]; };
    const Double3 at = corner(0) + along * (corner(1) - corner(0));
    return at + inwards * (0.5 * (corner(2) + corner(3)) - at);
  }

  const CheckScene& scene_;
  double extent_;
  Chance chance_;
};

}  // namespace

std::vector<Ray> rays_through(const CheckScene& scene, std::size_t count) {
  RayMaker maker(scene);
  std::vector<Ray> rays;
  rays.reserve(count);
  for (std::size_t k = 0; k < count; ++k) rays.push_back(maker.make(static_cast<Aim>(k % kAims)));
  return rays;
}

NearestHit hit_by_brute_force(const TileScene& scene, const Ray& ray) {
  return nearest_hit(scene, ray, [&](const TracedRay&, NearestPatch& nearest) {
    for (std::uint32_t patch = 0; patch < scene.patches; ++patch) nearest.look_at(scene.exact[patch], patch);
  });
}

HitFigures check_hits(const CheckScene& scene, const HitEffort& effort, int device, unsigned threads) {
  const SceneArrays arrays = arrays_of(scene, 1);
  const TileScene view = arrays.view();
  const auto walk = [&](const Ray& ray) { return nearest_hit(view, ray); };
  HitFigures figures;
  figures.scene = scene.name;
  figures.patches = scene.patches.size();

  const std::vector<Ray> some =
      rays_through(scene, static_cast<std::size_t>(std::max(
                              1000.0, effort.patch_tests / static_cast<double>(scene.patches.size()))));
  const Compared with_brute_force =
      compare(scene.name.c_str(), "brute force",
              all_hits(some, threads, [&](const Ray& ray) { return hit_by_brute_force(view, ray); }),
              all_hits(some, threads, walk));
  figures.rays = some.size();
  figures.hits = with_brute_force.hits;
  figures.differing = with_brute_force.differing;

  const std::vector<Ray> many = rays_through(scene, effort.timed_rays);
  const std::vector<Ray> timed(many.begin(), many.begin() + static_cast<std::ptrdiff_t>(many.size() / 10));
  const Stopwatch on_host;
  static_cast<void>(all_hits(timed, 1, walk));
  figures.host_rays_per_second = static_cast<double>(timed.size()) / on_host.seconds();
  if (device < 0) return figures;

  DeviceHits finder(arrays, device, free_memory_of(device));
  static_cast<void>(finder.find(many));  // a device that idled is slow
  const double kernel_before = finder.seconds().kernel;
  const Stopwatch on_device;
  const std::vector<NearestHit> found = finder.find(many);
  figures.device_rays_per_second = static_cast<double>(many.size()) / on_device.seconds();
  figures.kernel_rays_per_second =
      static_cast<double>(many.size()) / (finder.seconds().kernel - kernel_before);
  const Compared with_host = compare(scene.name.c_str(), "device", all_hits(many, threads, walk), found);
  figures.device_rays = many.size();
  figures.device_hits = with_host.hits;
  figures.device_differing = with_host.differing;
  return figures;
}

void print_hits(const std::vector<HitFigures>& figures) {
  std::printf(
      "\nfirst hits of rays, in millions a second; the host's by one core\n%-18s %8s %9s %9s %7s %9s "
      "%9s %7s %8s %8s %8s\n",
      "scene", "patches", "by force", "hits", "differ", "on GPU", "hits", "differ", "host", "GPU", "kernel");
  for (const HitFigures& row : figures)
    std::printf("%-18s %8zu %9" PRIu64 " %9" PRIu64 " %7" PRIu64 " %9" PRIu64 " %9" PRIu64 " %7" PRIu64
                " %8.3g %8.4g %8.4g\n",
                row.scene.c_str(), row.patches, row.rays, row.hits, row.differing, row.device_rays,
                row.device_hits, row.device_differing, 1e-6 * row.host_rays_per_second,
                1e-6 * row.device_rays_per_second, 1e-6 * row.kernel_rays_per_second);
}

std::string to_json(const std::vector<HitFigures>& figures) {
  const auto count = [](std::uint64_t value) { return json::number(static_cast<double>(value)); };
  std::vector<std::string> all;
  all.reserve(figures.size());
  for (const HitFigures& row : figures)
    all.push_back(json::object({{"scene", json::text(row.scene)},
                                {"patches", count(row.patches)},
                                {"rays", count(row.rays)},
                                {"hits", count(row.hits)},
                                {"differing", count(row.differing)},
                                {"device_rays", count(row.device_rays)},
                                {"device_hits", count(row.device_hits)},
                                {"device_differing", count(row.device_differing)},
                                {"host_rays_per_second", json::number(row.host_rays_per_second)},
                                {"device_rays_per_second", json::number(row.device_rays_per_second)},
                                {"kernel_rays_per_second", json::number(row.kernel_rays_per_second)}}));
  return json::list(all);
}

}  // namespace fluxel::cuda::checks
