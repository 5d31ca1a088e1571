#include "bench/gpu_check/octrees.hpp"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "bench/gpu_check/chance.hpp"
#include "bench/gpu_check/json.hpp"
#include "bench/gpu_check/stopwatch.hpp"
#include "octree/cuda/device_octree.hpp"
#include "octree/cuda/host_octree.hpp"

namespace fluxel::cuda::checks {

namespace {

/// Points of the host that are tested with every sphere.
constexpr std::size_t kCompared = 300;

float place(Chance& chance, double reach) { return static_cast<float>(chance.between(0, reach)); }

/// As far apart as they are large: some of them hold any point.
Sphere even(Chance& chance, double apart) {
  return {place(chance, 1), place(chance, 1), place(chance, 1), static_cast<float>(apart)};
}

/// Of many sizes, two thirds of them in a corner, as records of irradiance are.
Sphere crowded(Chance& chance, double apart) {
  const double reach = chance.below(3) == 0 ? 1 : 0.1;
  const float x = place(chance, reach), y = place(chance, reach), z = place(chance, reach);
  return {x, y, z, static_cast<float>(4 * reach * apart * std::pow(chance.between(0, 1), 4))};
}

/// At ten places, no two of them apart by a level.
Sphere alike(Chance& chance, double apart) {
  const float at = 0.1F * static_cast<float>(chance.below(10));
  return {at, at, at, static_cast<float>(0.1 * apart)};
}

struct Kind {
  const char* name;
  Sphere (*make)(Chance& chance, double apart);
};
constexpr Kind kKinds[] = {{"even", even}, {"crowded", crowded}, {"at ten places", alike}};

std::vector<OctreePoint> points_in(std::size_t count, Chance& chance) {
  std::vector<OctreePoint> points;
  points.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double reach = k % 2 == 0 ? 1.05 : 0.1;
    const double x = chance.between(-0.02, reach), y = chance.between(-0.02, reach);
    points.push_back({x, y, chance.between(-0.02, reach)});
  }
  return points;
}

std::uint64_t differing_look_ups(const HoldingSpheres& found, const std::vector<Sphere>& spheres,
                                 const std::vector<OctreePoint>& points) {
  std::uint64_t differing = 0;
  for (std::size_t k = 0; k < std::min(kCompared, points.size()); ++k) {
    std::vector<std::uint32_t> expected;
    for (std::uint32_t s = 0; s < spheres.size(); ++s)
      if (holds(spheres[s], points[k])) expected.push_back(s);
    const std::vector<std::uint32_t> listed(found.spheres.begin() + found.first[k],
                                            found.spheres.begin() + found.first[k + 1]);
    differing += listed != expected ? 1 : 0;
  }
  return differing;
}

/// All of the longer one where their sizes differ.
template <class T>
std::uint64_t differing_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  if (a.size() != b.size()) return std::max(a.size(), b.size()) * sizeof(T);
  std::uint64_t differing = 0;
  const auto* of_a = reinterpret_cast<const unsigned char*>(a.data());
  const auto* of_b = reinterpret_cast<const unsigned char*>(b.data());
  for (std::size_t k = 0; k < a.size() * sizeof(T); ++k) differing += of_a[k] != of_b[k] ? 1 : 0;
  return differing;
}

void check_device(const OctreeArrays& tree, const HoldingSpheres& found, const std::vector<Sphere>& spheres,
                  const std::vector<OctreePoint>& points, int device, OctreeFigures& figures) {
  const std::size_t memory = free_memory_of(device);
  { const DeviceOctree first(spheres, device, memory); }  // a device that idled is slow
  DeviceOctree octree(spheres, device, memory);
  figures.on_device = true;
  figures.device_build = octree.seconds().kernel;
  const OctreeArrays made = octree.arrays();
  const double kernel_before = octree.seconds().kernel;
  const Stopwatch watch;
  const HoldingSpheres looked_up = octree.find(points);
  const auto count = static_cast<double>(points.size());
  figures.device_points = count / watch.seconds();
  figures.kernel_points = count / (octree.seconds().kernel - kernel_before);
  figures.device_differing =
      differing_bytes(made.nodes, tree.nodes) + differing_bytes(made.references, tree.references) +
      differing_bytes(looked_up.first, found.first) + differing_bytes(looked_up.spheres, found.spheres);
}

OctreeFigures check_kind(const Kind& kind, std::size_t count, std::size_t point_count, int device) {
  Chance chance;
  const double apart = std::cbrt(1 / static_cast<double>(count));
  std::vector<Sphere> spheres;
  for (std::size_t k = 0; k < count; ++k) spheres.push_back(kind.make(chance, apart));
  const std::vector<OctreePoint> points = points_in(point_count, chance);
  OctreeFigures figures;
  figures.spheres_are = kind.name;
  figures.spheres = count;
  const Stopwatch build;
  const OctreeArrays tree = octree_on_host(spheres);
  figures.host_build = build.seconds();
  figures.nodes = tree.nodes.size();
  figures.references = tree.references.size();
  const Stopwatch look;
  const HoldingSpheres found = look_up_on_host(tree.view(), spheres, points);
  figures.points = points.size();
  figures.host_points = static_cast<double>(points.size()) / look.seconds();
  figures.found = found.spheres.size();
  figures.compared = std::min(kCompared, points.size());
  figures.differing = differing_look_ups(found, spheres, points);
  // A comparison of nothing would find no difference.
  if (figures.nodes < 9) throw std::logic_error("an octree was not divided: " + figures.spheres_are);
  if (device >= 0) check_device(tree, found, spheres, points, device, figures);
  return figures;
}

}  // namespace

std::vector<OctreeFigures> check_octrees(std::size_t spheres, std::size_t points, int device) {
  std::vector<OctreeFigures> figures;
  for (const Kind& kind : kKinds) figures.push_back(check_kind(kind, spheres, points, device));
  return figures;
}

void print_octrees(const std::vector<OctreeFigures>& figures) {
  std::printf(
      "\noctrees of references: look-ups against every sphere, and those of the GPU against the host's; "
      "building in ms, look-ups in millions a second, the host's by one core and the same passes\n%-14s %8s "
      "%8s %9s %8s %7s %7s %9s %9s %8s %8s %8s\n",
      "spheres", "number", "nodes", "referen.", "compared", "differ", "GPU", "host", "GPU", "look-up", "GPU",
      "kernel");
  for (const OctreeFigures& row : figures)
    std::printf("%-14s %8" PRIu64 " %8" PRIu64 " %9" PRIu64 " %8" PRIu64 " %7" PRIu64
                " %7s %9.3g %9.3g "
                "%8.3g %8.3g %8.3g%s\n",
                row.spheres_are.c_str(), row.spheres, row.nodes, row.references, row.compared, row.differing,
                row.on_device ? std::to_string(row.device_differing).c_str() : "-", 1e3 * row.host_build,
                1e3 * row.device_build, 1e-6 * row.host_points, 1e-6 * row.device_points,
                1e-6 * row.kernel_points, row.right() ? "" : "  WRONG");
}

std::string to_json(const std::vector<OctreeFigures>& figures) {
  const auto count = [](std::uint64_t value) { return json::number(static_cast<double>(value)); };
  std::vector<std::string> all;
  all.reserve(figures.size());
  for (const OctreeFigures& row : figures)
    all.push_back(json::object({{"spheres_are", json::text(row.spheres_are)},
                                {"spheres", count(row.spheres)},
                                {"nodes", count(row.nodes)},
                                {"references", count(row.references)},
                                {"compared", count(row.compared)},
                                {"found", count(row.found)},
                                {"differing", count(row.differing)},
                                {"points", count(row.points)},
                                {"device_differing", row.on_device ? count(row.device_differing) : "null"},
                                {"host_build_seconds", json::number(row.host_build)},
                                {"device_build_seconds", json::number(row.device_build)},
                                {"host_points_per_second", json::number(row.host_points)},
                                {"device_points_per_second", json::number(row.device_points)},
                                {"kernel_points_per_second", json::number(row.kernel_points)}}));
  return json::list(all);
}

}  // namespace fluxel::cuda::checks
